# Launch files cannot count cores: `nodes:=auto` of train.launch reads this.
export TRAIN_BRAKE_CORES=$(nproc)
