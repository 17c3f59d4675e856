#!/bin/sh
# Renews the pages and schemas that are made from the code. `make reference` calls it in the sourced workspace.
set -eu
cd "$(dirname "$0")/.."
export TRAIN_BRAKE_CONFIG="$PWD/config"
program=devel/lib/train_sim/train_sim

$program keys --markdown > docs/configuration.md
rm -f config/schema/*.schema.json
mkdir -p config/schema
$program keys --kinds | while read -r kind; do
  $program keys --json-schema "$kind" > "config/schema/$kind.schema.json"
done
$program keys --results > docs/result_files.md
tools/ros_interface.py > docs/ros_interface.md
