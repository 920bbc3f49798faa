#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Fuzzes the readers of what others write with libFuzzer, under address and undefined-behaviour
# sanitizers. Usage: tools/fuzz.sh [--seconds N] [READER...]
#   --seconds N  for each reader (60)
#   READER       a folder of tests/fuzz/corpus; all without it
# Starts from that folder, from files of ours of that kind, and from what earlier calls have gathered in
# build/fuzz/corpus. Prints a line a reader; exit status 1 if anything was found. What was found stands in
# build/fuzz/found: mend it and keep it in tests/fuzz/corpus, which every build reads.
set -euo pipefail
cd "$(dirname "$0")/.."
seconds=60
[ "${1:-}" = --seconds ] && seconds=$2 && shift 2
if [[ "${1:-}" == -* ]]; then
  sed -n 's/^# \?//p' "$0" | sed -n 3,10p >&2
  [ "$1" = --help ] && exit 0
  exit 64
fi
readers=("$@")
[ $# -gt 0 ] || mapfile -t readers < <(ls tests/fuzz/corpus)

EXTRA_PACKAGES="clang" tools/setup.sh fuzz oca_fuzz
fuzzer=$PWD/$(find build/fuzz -type f -name oca_fuzz -perm -u+x)
mkdir -p build/fuzz/found

gather() { # READER FOLDER: files of ours that it reads
  case $1 in
    document) find diagrams tests -name '*.yaml' -size -16k ;;
    csv) find docs models tests -name '*.csv' -size -16k ;;
    urdf) find models tests -name '*.urdf' -size -16k ;;
    srdf) find models tests -name '*.srdf' -size -16k ;;
  esac | while read -r file; do cp "$file" "$2/$(tr / _ <<< "$file")"; done
}

found=0
for reader in "${readers[@]}"; do
  [ -d "tests/fuzz/corpus/$reader" ] || { echo "no such reader: $reader" >&2; exit 64; }
  corpus=build/fuzz/corpus/$reader
  mkdir -p "$corpus"
  gather "$reader" "$corpus"
  log=build/fuzz/$reader.log
  status=0
  OCA_FUZZ_READER=$reader TMPDIR=/dev/shm "$fuzzer" -max_total_time="$seconds" -timeout=10 -rss_limit_mb=2048 -max_len=32768 \
    -artifact_prefix="build/fuzz/found/$reader-" "$corpus" "tests/fuzz/corpus/$reader" > "$log" 2>&1 || status=$?
  runs=$(awk '/^#[0-9]+/ { runs = substr($1, 2); for (i = 2; i < NF; ++i) if ($i == "cov:") covered = $(i + 1) }
              END { printf "%d inputs, %d branches", runs, covered }' "$log")
  if [ $status -eq 0 ]; then
    echo "pass  $reader: $runs"
  else
    found=1
    echo "FOUND $reader: $runs; see $log"
    grep -E 'SUMMARY|runtime error|Test unit written|terminate called|what\(\)' "$log" | sed 's/^/        /' || true
  fi
done
exit $found
