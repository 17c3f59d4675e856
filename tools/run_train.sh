#!/bin/bash
# Launches a train as a ROS graph and passes on the run's own exit code, which roslaunch does not.
#
# usage: tools/run_train.sh SCENARIO_FILE OUT_FOLDER [arg:=value of launch/train.launch ...]
# Exit codes are those of ltd_master (train_sim --help lists them; 4: a wagon node is missing, dead or late).
cd "$(dirname "$0")/.." || exit 1
. devel/setup.bash || exit 1

scenario=$(realpath -m "$1")
out=$(realpath -m "$2")
shift 2
vehicles=$(rosrun ltd_master train_sim check "$scenario") || exit 2
vehicles=$(sed -nE 's/.*: ([0-9]+) vehicle\(s\),.*/\1/p' <<<"$vehicles")

status=$(mktemp)
trap 'rm -f "$status"' EXIT
trap : INT TERM  # Ctrl-C reaches roslaunch, too: wait for it, then report
roslaunch train_brake train.launch scenario:="$scenario" vehicles:="$vehicles" out:="$out" \
  exit_status_file:="$status" "$@" &
launch=$!
while kill -0 $launch 2>/dev/null; do wait $launch; done
code=$(cat "$status")
exit "${code:-1}"
