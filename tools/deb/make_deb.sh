#!/bin/bash
# Packs an install space as the Debian packages train-brake and train-brake-rviz.
#
# usage: tools/deb/make_deb.sh ROOT OUT    ROOT: what `catkin_make install` made with DESTDIR and the prefix
# /opt/train_brake
set -eo pipefail
root=$(realpath "$1") out=$2
here=$(cd "$(dirname "$0")" && pwd)
prefix=/opt/train_brake
version=$(sed -nE 's:.*<version>(.*)</version>.*:\1:p' "$here/../../src/train_brake/package.xml")
architecture=$(dpkg --print-architecture)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# What is not for users of the package: headers, archives, files of CMake, compiled Python.
main=$work/train-brake rviz=$work/train-brake-rviz
mkdir -p "$main" "$rviz" "$out"
cp -a "$root/opt" "$main/"
find "$main" -name __pycache__ -prune -exec rm -rf {} +
rm -rf "$main$prefix/include" "$main$prefix"/lib/*.a "$main$prefix/lib/pkgconfig" "$main$prefix"/share/*/cmake
{ grep -rlI "$root" "$main" || true; } | xargs -r sed -i "s:$root::g"   # paths of the folder that it was staged in
(cd "$main$prefix" && find . \( -path './lib/*train_brake_rviz*' -o -path './share/train_brake_rviz*' \) \
  \( -type f -o -type l \) -print0) |
  while IFS= read -r -d '' file; do
    mkdir -p "$rviz$prefix/$(dirname "$file")" && mv "$main$prefix/$file" "$rviz$prefix/$file"
  done
find "$main" -type d -empty -delete
find "$main$prefix/lib" "$rviz$prefix/lib" -type f \( -name '*.so' -o -perm -100 \) \
  -exec sh -c 'file -b "$1" | grep -q ^ELF && strip --strip-unneeded "$1"' _ {} \;

mkdir -p "$main/usr/bin" "$main/usr/share/man/man1" "$main/usr/share/doc/train-brake" \
  "$rviz/usr/share/doc/train-brake-rviz"
cat >"$main/usr/bin/train_sim" <<END
#!/bin/sh
# The program, with the shipped parts behind those of the caller.
export TRAIN_BRAKE_CONFIG="\${TRAIN_BRAKE_CONFIG:+\$TRAIN_BRAKE_CONFIG:}$prefix/share/train_brake/config"
export LD_LIBRARY_PATH="$prefix/lib\${LD_LIBRARY_PATH:+:\$LD_LIBRARY_PATH}"
exec $prefix/lib/train_sim/train_sim "\$@"
END
chmod 755 "$main/usr/bin/train_sim"
LD_LIBRARY_PATH=$main$prefix/lib "$here/../man_page.py" "$main$prefix/lib/train_sim/train_sim" |
  gzip -9n >"$main/usr/share/man/man1/train_sim.1.gz"
for package in train-brake train-brake-rviz; do
  cp "$here/../../LICENSE" "$work/$package/usr/share/doc/$package/copyright"
done
cp "$here/../../CHANGELOG.md" "$main/usr/share/doc/train-brake/"
cp -r "$here/../../docs" "$main/usr/share/doc/train-brake/"

libraries() {  # that the programs of a folder need, as packages
  mkdir -p "$work/shlibs/debian" && : >"$work/shlibs/debian/control"
  (cd "$work/shlibs" && find "$1" -type f -exec sh -c 'file -b "$1" | grep -q ^ELF' _ {} \; -print0 |
    xargs -0 dpkg-shlibdeps --ignore-missing-info -l"$main$prefix/lib" -l"$rviz$prefix/lib" -O 2>/dev/null |
    sed 's/^shlibs:Depends=//')
}
control() {  # PACKAGE DEPENDS SUMMARY TEXT
  mkdir -p "$work/$1/DEBIAN"
  cat >"$work/$1/DEBIAN/control" <<END
Package: $1
Version: $version
Architecture: $architecture
Maintainer: the train_brake contributors <train_brake@example.org>
Section: science
Priority: optional
Installed-Size: $(du -sk --exclude=DEBIAN "$work/$1" | cut -f1)
Depends: $2
Description: $3
 $4
END
  chmod -R u=rwX,go=rX "$work/$1"
  dpkg-deb --root-owner-group --build "$work/$1" "$out/${1}_${version}_$architecture.deb" >/dev/null
  echo "$out/${1}_${version}_$architecture.deb"
}
mkdir -p "$main/DEBIAN"
cat >"$main/DEBIAN/prerm" <<END
#!/bin/sh
# What Python compiled here since belongs to no package, and would keep the folders.
set -e
[ ! -d $prefix ] || find $prefix -name __pycache__ -type d -prune -exec rm -rf {} +
END
chmod 755 "$main/DEBIAN/prerm"
control train-brake "$(libraries "$main$prefix"), $(grep -v '^#' "$here/depends.txt" | paste -sd, | sed 's/,/, /g')" \
  "braking of long freight trains, simulated as ROS nodes or in one process" \
  "The program train_sim, ROS nodes, scenarios and reports, under $prefix; source $prefix/setup.bash."
control train-brake-rviz "train-brake (= $version), $(libraries "$rviz$prefix"), rviz" \
  "the train of train-brake in rviz" "A panel and markers for rviz."
