#!/bin/sh
# Installs the Debian packages of packages.txt, and of further lists in this folder, that are missing; says nothing when
# none is.
#
# usage: tools/install_packages.sh [LIST ...]
set -eu

packages=$(cd "$(dirname "$0")" && sed "s/#.*//" packages.txt "$@")

case "${ROS_DISTRO:-Debian}" in
  Debian) ;;
  *)
    # A ROS of another origin is in use (its setup file was sourced): Debian's ROS packages would clash with it.
    echo "ROS $ROS_DISTRO is in use, so no package is installed. If the build misses one:"
    echo "  rosdep install --from-paths src --ignore-src   (tools/rosdep.yaml adds a key that rosdistro lacks)"
    exit 0 ;;
esac

if ! command -v apt-get >/dev/null || ! command -v dpkg-query >/dev/null; then
  echo "This system has no apt-get, so no package is installed. The build needs ROS 1 (catkin, message_generation,"
  echo "rosbag_storage), GCC 11 or clang, CMake 3.16, Boost, CLI11, Eigen 3, fmt, GoogleTest, nlohmann-json," \
    "xxHash and yaml-cpp."
  echo "Simplest is a container or chroot with Debian 12, where 'make' does all the rest."
  exit 0
fi

missing=
for package in $packages; do
  [ "$(dpkg-query -W -f '${db:Status-Status}' "$package" 2>/dev/null)" = installed ] || missing="$missing $package"
done
[ -n "$missing" ] || exit 0

as_root=
if [ "$(id -u)" -ne 0 ]; then
  if ! command -v sudo >/dev/null; then
    echo "These packages are missing, and there is no sudo to install them. As root, run:" >&2
    echo "  apt-get update && apt-get install$missing" >&2
    exit 1
  fi
  as_root=sudo
fi
apt_get="$as_root env DEBIAN_FRONTEND=noninteractive apt-get -q -o DPkg::Lock::Timeout=300"

echo "Installing:$missing"
$apt_get update
# shellcheck disable=SC2086  # one argument per package
$apt_get install -y --no-install-recommends $missing
