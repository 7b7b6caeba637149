#!/bin/sh
# A campaign in shards by GNU parallel: machine file, draws, shards.
#
#     parallel.sh hoist.toml 10000 8
#
# Further options of GNU parallel stand in PARALLEL, such as PARALLEL='--sshloginfile nodes --workdir .' for machines
# that share this folder. A shard that was killed goes on where it was when the script is run again.
set -eu
machine=$1
draws=$2
name=$(basename "$machine" .toml)
shards=$3
seq "$shards" | parallel --halt soon,fail=1 cargo-driveline campaign "$machine" --draws "$draws" --threads 1 \
    --shard "{}/$shards" --results "$name-{}.draws"
cargo-driveline campaign merge $(seq -f "$name-%g.draws" "$shards") --results "$name.draws"
