#!/bin/bash
# Installs the packages of a folder on a bare Debian 12 (debootstrap), runs trains with them, removes them. Needs root
# and a Debian mirror.
#
# usage: tools/deb/test_deb.sh FOLDER [ROOT]    ROOT: a bare root that is there already, or where it shall stay
set -eo pipefail
packages=$(realpath "$1")
[ "$(id -u)" = 0 ] || { echo "test_deb: needs root" >&2; exit 1; }
made=  # a folder that this script made and removes at its end; a ROOT that was given is never removed
if [ -n "$2" ]; then
  root=$(realpath "$2")
else
  made=$(mktemp -d) root=$made/root
fi
readonly made root
mirror=${MIRROR:-http://deb.debian.org/debian}
[ -e "$root/etc/debian_version" ] || debootstrap --variant=minbase bookworm "$root" "$mirror" >/dev/null
cp /etc/resolv.conf "$root/etc/resolv.conf"
[ -e "$root/etc/hosts" ] || echo "127.0.0.1 localhost" >"$root/etc/hosts"  # a bare root has none, and ROS asks for it
[ ! -e /etc/apt/apt.conf ] || cp /etc/apt/apt.conf "$root/etc/apt/"
mkdir -p "$root/packages" && cp "$packages"/train-brake_*.deb "$root/packages/"
# Positional parameters would be those of a function that fails: none here. Nothing is removed while anything is mounted
# below it.
end() {
  for mounted in dev/shm dev proc; do
    ! mountpoint -q "$root/$mounted" || umount "$root/$mounted" ||
      { echo "test_deb: $root/$mounted is still mounted" >&2; return; }
  done
  [ -z "$made" ] || rm -rf --one-file-system "$made"
}
trap end EXIT
mount --bind /proc "$root/proc"; mount --bind /dev "$root/dev"; mount -t tmpfs tmpfs "$root/dev/shm"
run() {
  echo "== $*"
  chroot "$root" env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/srv DEBIAN_FRONTEND=noninteractive \
    bash -eo pipefail -c "$*"
}

run 'apt-get -q update >/dev/null
  apt-get -q install -y --no-install-recommends /packages/train-brake_*.deb >/tmp/apt.log 2>&1 ||
    { tail -20 /tmp/apt.log; exit 1; }'
run 'cd / && train_sim --version && train_sim check /opt/train_brake/share/train_brake/config/scenarios/emergency.yaml'
run 'mkdir -p /srv/mine && cd /srv/mine &&
  printf "base: single_wagon_stop\nname: mine\ninitial_speed_kmh: 50\n" >mine.yaml &&
  cp /opt/train_brake/share/train_brake/config/scenarios/single_wagon_stop.yaml . &&
  train_sim run mine.yaml --out stop >/dev/null 2>&1 && train_sim verify stop'
run 'cd /srv/mine && . /opt/train_brake/setup.bash && rosrun train_brake report stop &&
  rosrun train_brake export stop tables && rosrun train_brake sweep mine.yaml nine --grid initial_speed_kmh=20:60:9'
run 'cd /srv/mine && . /opt/train_brake/setup.bash &&
  rosrun train_brake run /opt/train_brake/share/train_brake/config/scenarios/emergency.yaml graph'
run 'gzip -t /usr/share/man/man1/train_sim.1.gz 2>/dev/null || [ ! -e /usr/share/man ] ||
  echo "no manual page: the root excludes documentation"'
run 'apt-get -q remove -y train-brake >/dev/null; test ! -e /opt/train_brake; test ! -e /usr/bin/train_sim'
echo "test_deb: installed, ran, removed"
