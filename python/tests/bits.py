"""Words of a machine's drive: `bits.py MACHINE NUMBER` reads rows of eight from `input`, writes `output`."""

import sys

import numpy as np

import driveline

drive = driveline.Machine(sys.argv[1]).drive(sys.argv[2])
drive.exchange(np.fromfile("input", dtype="<u4").reshape(-1, 8)).tofile("output")
