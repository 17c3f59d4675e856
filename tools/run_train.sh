#!/bin/bash
# Launches a train as a ROS graph, makes the report on the run (OUT_FOLDER/report.html), and passes on the run's own exit
# code, which roslaunch does not.
#
# usage: tools/run_train.sh SCENARIO_FILE OUT_FOLDER [arg:=value of launch/train.launch ...]
# Exit codes are those of ltd_master (train_sim --help lists them; 4: a wagon node is missing, dead or late).
# Relative paths are those of the caller's folder, in arguments of the launch file, too.
top=$(realpath "$(dirname "$0")/..")
. "$top/devel/setup.bash" || exit 1

scenario=$(realpath -m "$1")
out=$(realpath -m "$2")
shift 2
vehicles=$(rosrun train_sim train_sim check "$scenario") || exit 2
vehicles=$(sed -nE 's/.*: ([0-9]+) vehicle\(s\),.*/\1/p' <<<"$vehicles")

status=$(mktemp)
trap 'rm -f "$status"' EXIT
trap : INT TERM  # Ctrl-C reaches roslaunch, too: wait for it, then report
trap '' PIPE
# roslaunch ends where its output cannot be written. A terminal gets it as it comes; what else reads it may go away.
shield() { (trap '' INT TERM; cat || cat >/dev/null) 2>/dev/null; }
[ -t 1 ] || exec > >(shield)
[ -t 2 ] || exec 2> >(shield >&2)
roslaunch train_brake train.launch scenario:="$scenario" vehicles:="$vehicles" out:="$out" \
  exit_status_file:="$status" "$@" &
launch=$!
while kill -0 "$launch" 2>/dev/null; do wait "$launch"; done
code=$(cat "$status")

# Code 2: nothing was written. What is in the folder is of an earlier run, if there is anything.
if [ -n "$code" ] && [ "$code" != 2 ] && [ -e "$out/train.bag" ]; then
  rosrun train_brake report "$out" || echo "The report on the run could not be made. The run itself ended with code $code." >&2
fi
exit "${code:-1}"
