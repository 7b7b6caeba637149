# %% [markdown]
# # From a recording to a machine, from readings to weights

# %%
import tempfile
from pathlib import Path

import numpy as np

import driveline

folder = Path(tempfile.mkdtemp())
recording = folder / "bench.csv"
recording.write_text(driveline.example("bench-log"))

# %%
found = driveline.identify(recording, rate=2500, torque_constant=0.564, to=5)
for name in ["motor_inertia", "load_inertia", "stiffness", "resonance"]:
    print(f"{name}: {found[name]['value']:.4g} +- {found[name]['standard_deviation']:.1g}")

# %% [markdown]
# The observer of that machine over the rest of the recording.

# %%
replayed = found["machine"].replay(recording, rate=2500, torque_constant=0.564, delay=1.2e-4, from_=5)
print(replayed["samples"], "samples;", ", ".join(replayed["course"]))

# %%
readings = folder / "fan-balance.toml"
readings.write_text(driveline.example("fan-balance"))
balanced = driveline.balancing(readings)
for plane in balanced["planes"]:
    print(plane["plane"], plane["weight"])
