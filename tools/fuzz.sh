#!/bin/bash
# Runs the fuzzers of `make fuzz` one after the other; ends with 1 if one has found something.
#
# usage: tools/fuzz.sh BUILD_FOLDER DEVEL_FOLDER SECONDS_EACH
#
# What a fuzzer learns it keeps in BUILD_FOLDER/learned, for its next run; a finding goes to BUILD_FOLDER/findings. Once
# mended, a finding belongs into src/PACKAGE/fuzz/corpus/NAME, which is run by `make test`, too.
set -u
build=$1 devel=$2 seconds=$3
mkdir -p "$build/findings"
status=0
for fuzzer in "$devel"/lib/*/*_fuzz; do
  package=$(basename "$(dirname "$fuzzer")")
  name=$(basename "$fuzzer" _fuzz)
  name=${name#"${package}_"}
  learned=$build/learned/$name
  log=$build/$name.log
  mkdir -p "$learned"
  printf '%-20s ' "$name"
  if "$fuzzer" -max_total_time="$seconds" -timeout=60 -rss_limit_mb=4096 -max_len=16384 -print_final_stats=1 \
    -dict=src/train_dynamics/fuzz/dictionary.txt -artifact_prefix="$build/findings/$name-" \
    "$learned" "src/$package/fuzz/corpus/$name" >"$log" 2>&1; then
    sed -n 's/^stat::number_of_executed_units: *\(.*\)/\1 inputs, nothing found/p' "$log"
  else
    echo "FOUND something, see $log:"
    grep -E 'ERROR|what\(\)|runtime error|does not hold|SUMMARY|Test unit written' "$log" | sed 's/^/  /'
    status=1
  fi
done
exit $status
