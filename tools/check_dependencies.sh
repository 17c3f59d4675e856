#!/bin/sh
# The dependency rules of docs/architecture.md, checked on the include lines.
set -u
cd "$(dirname "$0")/../src" || exit 1
status=0

# forbid PATTERN RULE PATH...: no file under the paths may include what matches the pattern.
forbid() {
  pattern=$1 rule=$2
  shift 2
  found=$(grep -rnE --include='*.h' --include='*.cpp' "^ *# *include *[<\"]($pattern)" "$@" 2>/dev/null)
  [ -z "$found" ] && return
  printf '%s\n  rule: %s\n' "$found" "$rule" >&2
  status=1
}

# Folders of train_dynamics, headers and sources.
layers() {
  for layer in "$@"; do
    printf '%s\n' train_dynamics/include/train_dynamics/"$layer" train_dynamics/src/"$layer"
  done
}
elements="contact suspension coupler brake resistance traction track"

forbid '(ros|rosbag|std_msgs|train_brake_msgs|ltd_master|wagon_node)/' \
  'train_dynamics knows nothing of ROS, messages or nodes' train_dynamics
# shellcheck disable=SC2046,SC2086  # one argument per folder
{
  forbid 'yaml-cpp/|train_dynamics/config/' \
    'only config/ reads YAML; physics gets plain structs' $(layers numeric $elements vehicle train)
  forbid 'train_dynamics/(contact|suspension|coupler|brake|resistance|traction|track|vehicle|train)/' \
    'numeric/ stands below all physics' $(layers numeric)
  forbid 'train_dynamics/(vehicle|train)/' \
    'elements stand below vehicle/ and train/' $(layers $elements)
  forbid 'train_dynamics/train/' \
    'vehicle/ stands below train/' $(layers vehicle)
}
forbid '(ros|tf2_ros|rviz|Q[A-Z]|[a-z_]+_msgs/)' 'what is drawn (board/) knows nothing of ROS, messages or windows' \
  train_brake_rviz/include/train_brake_rviz/board train_brake_rviz/src/board
forbid '(ltd_master|wagon_node)/' 'train_brake_rviz meets the run in train_brake_msgs only' train_brake_rviz
forbid 'wagon_node/' 'ltd_master and wagon_node meet in train_brake_msgs only' ltd_master
forbid 'ltd_master/' 'ltd_master and wagon_node meet in train_brake_msgs only' wagon_node

exit $status
