#!/bin/sh
# A campaign in shards by GNU parallel: scene, draws, shards.
#
#     parallel.sh hoist 10000 8
#
# Further options of GNU parallel stand in PARALLEL, such as PARALLEL='--sshloginfile nodes --workdir .' for machines
# that share this folder. A shard that was killed goes on where it was when the script is run again.
set -eu
scene=$1
draws=$2
shards=$3
seq "$shards" | parallel --halt soon,fail=1 cargo-driveline campaign "$scene" --draws "$draws" --threads 1 \
    --shard "{}/$shards" --results "$scene-{}.draws"
cargo-driveline campaign merge $(seq -f "$scene-%g.draws" "$shards") --results "$scene.draws"
