# Launch files cannot count cores: `nodes:=auto` of train.launch reads this.
export TRAIN_BRAKE_CORES=$(nproc)

# Where names of parts are looked for besides the folders above a scenario: behind your own folders, the shipped parts.
@[if DEVELSPACE]@
_train_brake_config="@(PROJECT_SOURCE_DIR)/config"
@[else]@
_train_brake_config="$CATKIN_ENV_HOOK_WORKSPACE/@(CATKIN_PACKAGE_SHARE_DESTINATION)/config"
@[end if]@
case ":${TRAIN_BRAKE_CONFIG:-}:" in
  *":$_train_brake_config:"*) ;;
  *) export TRAIN_BRAKE_CONFIG="${TRAIN_BRAKE_CONFIG:+$TRAIN_BRAKE_CONFIG:}$_train_brake_config" ;;
esac
unset _train_brake_config

# `train_sim` without rosrun.
_train_brake_bin="$CATKIN_ENV_HOOK_WORKSPACE/lib/train_sim"
case ":$PATH:" in
  *":$_train_brake_bin:"*) ;;
  *) export PATH="$_train_brake_bin:$PATH" ;;
esac
unset _train_brake_bin
