#!/bin/sh
# The dependency rules of docs/architecture.md, checked on the include lines. Ends with 1 if one is broken, or if a
# folder that a rule is about does not exist.
set -u
cd "$(dirname "$0")/../src" || exit 1
status=0

# forbid PATTERN RULE PATH...: no file under the paths may include what matches the pattern.
forbid() {
  pattern=$1 rule=$2
  shift 2
  for path in "$@"; do
    [ -d "$path" ] && continue
    printf 'no such folder: src/%s\n  rule: %s\n' "$path" "$rule" >&2
    status=1
  done
  found=$(grep -rnE --include='*.h' --include='*.cpp' "^ *# *include *[<\"]($pattern)" "$@" 2>/dev/null)
  [ -z "$found" ] && return
  printf '%s\n  rule: %s\n' "$found" "$rule" >&2
  status=1
}

# Headers and, where there are any, sources of rooms of train_dynamics.
rooms() {
  for room in "$@"; do
    echo "train_dynamics/include/train_dynamics/$room"
    [ ! -d "train_dynamics/src/$room" ] || echo "train_dynamics/src/$room"
  done
}
elements="contact suspension coupler brake traction resistance track slide_protection"

programs='train_sim|ltd_master|wagon_node'
forbid "(ros|rosbag|std_msgs|train_brake_msgs|train_dynamics|train_results|train_run|$programs)/" \
  'strict_config knows neither trains nor ROS' strict_config
forbid '(ros|rosbag|std_msgs|train_brake_msgs|train_results|train_run|train_sim|ltd_master|wagon_node)/' \
  'train_dynamics knows nothing of ROS, messages, results or nodes' train_dynamics
# shellcheck disable=SC2046,SC2086  # one argument per folder
{
  yaml='reader|writer|part_library|overrides|yaml_tree|scalar|suggestion|text_file'
  forbid "yaml-cpp/|train_dynamics/config/|strict_config/($yaml)" \
    'only config/ reads YAML; physics gets plain structs' $(rooms numeric $elements vehicle train)
  all_elements=$(echo $elements | tr ' ' '|')
  forbid "train_dynamics/(spring|$all_elements|vehicle|train)/" \
    'numeric/ stands below all physics' $(rooms numeric)
  forbid "train_dynamics/($all_elements|vehicle|train)/" \
    'spring/ holds what several elements are made of' $(rooms spring)
  forbid 'train_dynamics/(vehicle|train)/' \
    'elements stand below vehicle/ and train/' $(rooms $elements)
  for element in $elements; do
    others=$(printf '%s\n' $elements | grep -vx "$element" | paste -sd '|')
    [ $element != track ] || others=$(echo "$others" | sed 's/contact|//')
    forbid "train_dynamics/($others)/" \
      'elements do not lean on each other, but for track: rails have surfaces of contact/' $(rooms $element)
  done
  forbid 'train_dynamics/train/' \
    'vehicle/ stands below train/' $(rooms vehicle)
}
forbid '(ros/ros|ros/node_handle|ros/publisher|train_run|train_sim|ltd_master|wagon_node)' \
  'results are written and read without a running graph' train_results
forbid '(ros|strict_config|train_(brake_msgs|dynamics|node|results|run|sim)|ltd_master|wagon_node)/' \
  'train_console knows nothing of the rest' train_console
forbid '(train_(brake_msgs|dynamics|results|run|sim)|ltd_master|wagon_node)/' \
  'train_node is what all nodes need, whatever they do' train_node
forbid '(ros/ros|train_sim|ltd_master|wagon_node)' 'a run knows neither its program nor a running graph' train_run
forbid '(ros/ros|ltd_master|wagon_node)' 'train_sim runs without a graph' train_sim
forbid '(ros|tf2_ros|rviz|Q[A-Z]|[a-z_]+_msgs/)' 'what is drawn (board/) knows nothing of ROS, messages or windows' \
  train_brake_rviz/include/train_brake_rviz/board train_brake_rviz/src/board
forbid '(train_results|train_run|train_sim|ltd_master|wagon_node)/' \
  'train_brake_rviz meets the run in train_brake_msgs only' train_brake_rviz
forbid '(wagon_node|train_sim)/' 'ltd_master and wagon_node meet in train_brake_msgs only' ltd_master
forbid '(train_results|train_run|train_sim|ltd_master)/' \
  'ltd_master and wagon_node meet in train_brake_msgs only' wagon_node

# What programs say goes through train_console, so that a message that cannot be written does not end a run.
if grep -rnE --include='*.h' --include='*.cpp' 'fmt::print\((stderr|")|std::(cerr|cout)\b *<<' . |
  grep -vE '/(test|bench|fuzz)/|///'; then
  echo '  rule: messages by train_console::Tell, output by train_console::Print' >&2
  status=1
fi

exit $status
