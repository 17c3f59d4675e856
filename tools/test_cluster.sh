#!/bin/bash
# Runs a train over several "machines", loses one of them on the way, and compares its digest with the same train in one
# process.
#
# The machines are network namespaces of this one, each with an address, its own loopback and an sshd; roslaunch reaches
# them over ssh as it would any machine. They do not see each other's processes, which would share memory. The launch
# file alone says which vehicles run where. Needs root; removes all that it made. `make test-cluster` calls it.
# (No set -u: the setup files of ROS read variables that may be unset.)
cd "$(dirname "$0")/.." || exit 1
[ "$(id -u)" = 0 ] || { echo "test-cluster: network namespaces need root: run it with sudo" >&2; exit 1; }

machines=3
ranks=7   # not a multiple: blocks of unequal size
net=10.77.31
name=tb$$
work=$(mktemp -d)
workspace=$PWD
lo_ok() { ip netns add "$1" 2>/dev/null && ip netns exec "$1" ip link set lo up 2>/dev/null; }

cleanup() {
  jobs -p | xargs -r kill 2>/dev/null
  for i in $(seq $machines); do
    ip netns pids ${name}m$i 2>/dev/null | xargs -r kill -9 2>/dev/null
    ip netns del ${name}m$i 2>/dev/null
  done
  ip link del ${name}br 2>/dev/null
  rm -rf "$work"
}
trap cleanup EXIT
trap 'exit 130' INT TERM

if ! lo_ok ${name}m1; then
  echo "test-cluster: this machine does not allow network namespaces" >&2
  [ "${CLUSTER_OPTIONAL:-}" = 1 ] && { echo "test-cluster: skipped"; exit 0; }
  exit 1
fi

# The network: a bridge here, one leg into each machine.
ip link add ${name}br type bridge && ip addr add $net.1/24 dev ${name}br && ip link set ${name}br up || exit 1
for i in $(seq $machines); do
  [ $i = 1 ] || lo_ok ${name}m$i || exit 1
  ip link add ${name}v$i type veth peer name eth0 netns ${name}m$i
  ip link set ${name}v$i master ${name}br up
  ip netns exec ${name}m$i ip addr add $net.$((10 + i))/24 dev eth0
  ip netns exec ${name}m$i ip link set eth0 up
done

# Keys, and an sshd on each machine. Paramiko knows neither our host keys nor our login but by this HOME.
mkdir -p "$work/home/.ssh" "$work/sshd" /run/sshd
chmod 700 "$work/home/.ssh"
ssh-keygen -q -t rsa -b 2048 -m PEM -N '' -f "$work/home/.ssh/id_rsa"
ssh-keygen -q -t rsa -b 2048 -m PEM -N '' -f "$work/sshd/host_key"
cp "$work/home/.ssh/id_rsa.pub" "$work/sshd/authorized_keys"
chmod 755 "$work"; chmod 600 "$work/sshd/authorized_keys"
addresses=()
for i in $(seq $machines); do
  address=$net.$((10 + i))
  addresses+=("$address")
  ip netns exec ${name}m$i unshare --pid --fork --mount-proc /usr/sbin/sshd -D -e -p 22 \
    -h "$work/sshd/host_key" -o ListenAddress=$address -o PidFile=none -o UsePAM=no -o StrictModes=no \
    -o PermitRootLogin=prohibit-password -o AuthorizedKeysFile="$work/sshd/authorized_keys" >"$work/sshd/$i.log" 2>&1 &
  disown
  echo "$address $(cut -d' ' -f1,2 "$work/sshd/host_key.pub")" >>"$work/home/.ssh/known_hosts"
done

# What a user installs on each machine: a script that sets up the environment (docs/cluster.md).
cat >"$work/env.sh" <<ENV
#!/bin/bash
. "$workspace/devel/setup.bash"
export ROS_IP=\$(cut -d' ' -f3 <<<"\$SSH_CONNECTION")
exec "\$@"
ENV
chmod +x "$work/env.sh"

# The digest in a summary.json.
digest_in() {
  /usr/bin/python3 -c 'import json, sys; print(json.load(open(sys.argv[1]))["state_digest"])' "$1"
}

. devel/setup.bash
unset ROS_HOSTNAME  # it would go before ROS_IP
export HOME=$work/home ROS_IP=$net.1 ROS_MASTER_URI=http://$net.1:11311
scenario=$workspace/config/scenarios/emergency.yaml
change="duration_s=1"
expected=$(rosrun train_sim train_sim run "$scenario" --json --set $change | digest_in /dev/stdin)

# Where the wagon nodes really are, while they run.
watch_placement() {
  while sleep 0.2; do
    for i in $(seq $machines); do
      count=0
      for pid in $(ip netns pids ${name}m$i 2>/dev/null); do
        [ "$(cat /proc/"$pid"/comm 2>/dev/null)" = wagon_node ] && count=$((count + 1))
      done
      [ "$count" -gt "$(cat "$work/placed$i" 2>/dev/null || echo 0)" ] && echo $count >"$work/placed$i"
    done
  done
}
watch_placement &
watcher=$!

# (Without shared memory, which these machines would have: they are one.)
timeout 120 roslaunch train_brake emergency.launch nodes:=$ranks machines:="${addresses[*]}" \
  env_loader:="$work/env.sh" user:=root out:="$work/out" set:="$change" shared_memory:=false \
  exit_status_file:="$work/status" >"$work/launch.log" 2>&1
kill $watcher 2>/dev/null
code=$(cat "$work/status" 2>/dev/null || echo "none")
got=$(digest_in "$work/out/summary.json" 2>/dev/null)
placed=$(for i in $(seq $machines); do cat "$work/placed$i" 2>/dev/null || echo 0; done | xargs)
left=$(for i in $(seq $machines); do ip netns pids ${name}m$i; done | xargs -r ps -o comm= -p | grep -c wagon_node)

echo "machines            ${addresses[*]}"
echo "wagon nodes on each $placed (of $ranks)"
echo "exit code           $code"
echo "digest              $got"
echo "in one process      $expected"
echo "left behind         $left"
failed() {
  tail -n 40 "$work"/*.log "$work"/sshd/*.log >&2
  echo "test-cluster: FAILED" >&2
  exit 1
}
[ "$code" = 0 ] && [ -n "$expected" ] && [ "$got" = "$expected" ] && [ "$placed" = "3 2 2" ] && [ "$left" = 0 ] ||
  failed

# A study whose runs are dealt to two of the machines by GNU parallel (docs/studies.md): the table of one that was run
# here.
study() {
  rosrun train_brake sweep "$workspace/config/scenarios/single_wagon_stop.yaml" "$work/$1" \
    --grid initial_speed_kmh=40:80:6 "${@:2}" >/dev/null 2>&1
}
study here && study far --plan-only && mkdir -p "$work/remote" || failed
(cd "$work" && parallel --will-cite \
  --ssh "ssh -i $work/home/.ssh/id_rsa -o UserKnownHostsFile=$work/home/.ssh/known_hosts" \
  --sshlogin "1/root@${addresses[0]},1/root@${addresses[1]}" --workdir "$work/remote" --joblog "$work/joblog" \
  --transferfile far/runs/{}/config.yaml --return far/runs/{}/summary.json --cleanup \
  ". $workspace/devel/setup.bash; train_sim run far/runs/{}/config.yaml --json --threads 1 > far/runs/{}/summary.json" \
  :::: far/jobs.txt) \
  >"$work/parallel.log" 2>&1 || failed
rosrun train_brake sweep "$work/far" --collect >/dev/null || failed
cmp "$work/here/results.csv" "$work/far/results.csv" || failed
hosts=$(tail -n +2 "$work/joblog" | cut -f2 | sort -u | wc -l)
echo "study: 6 runs over $hosts machines, the table of one machine"
[ "$hosts" = 2 ] || failed

# Two runs that lose a machine: first its link, for a while (a node that has replied before is not even missed); then
# the machine itself, for good, and its two nodes are started by hand on another one.
change="duration_s=8"
expected=$(rosrun train_sim train_sim run "$scenario" --json --set $change | digest_in /dev/stdin)

lose_link() {
  ip link set ${name}v2 down
  sleep 4
  ip link set ${name}v2 up
}
lose_machine() {
  ip netns pids ${name}m2 | xargs kill -9 2>/dev/null
  for node in wagon_104 wagon_139; do
    ROS_IP=$net.13 ROS_NAMESPACE=train ip netns exec ${name}m3 rosrun wagon_node wagon_node __name:=$node \
      >>"$work/by_hand.log" 2>&1 &
    disown
  done
}

for loss in lose_link lose_machine; do
  rm -f "$work/status"
  timeout 120 roslaunch --sigint-timeout=3 train_brake emergency.launch nodes:=$ranks machines:="${addresses[*]}" \
    env_loader:="$work/env.sh" user:=root out:="$work/out" set:="$change" real_time_factor:=1 exchange_timeout:=2 \
    exit_status_file:="$work/status" >"$work/$loss.log" 2>&1 &
  launch=$!
  for _ in $(seq 60); do  # until the ROS master is there, and then until 2 s of the run have passed
    timeout 60 rostopic echo -n 1 --filter "m.exchange >= 2000" /train/live/status >/dev/null 2>&1 && break
    sleep 0.5
  done
  recovered="any(v.key == 'recoveries' and int(v.value) > 0 for s in m.status for v in s.values)"
  timeout 120 rostopic echo -n 1 --filter "$recovered" \
    /diagnostics >"$work/recovered" 2>/dev/null &
  counting=$!
  $loss
  wait $launch
  kill $counting 2>/dev/null
  wait $counting 2>/dev/null
  code=$(cat "$work/status" 2>/dev/null || echo "none")
  got=$(digest_in "$work/out/summary.json" 2>/dev/null)
  back=no
  [ -s "$work/recovered" ] && back=yes
  printf '%-19s exit code %s, digest %s (in one process %s), nodes brought back: %s\n' \
    $loss "$code" "$got" "$expected" $back
  [ "$code" = 0 ] && [ "$got" = "$expected" ] && [ $back = yes ] || failed
done
echo "test-cluster: passed"
