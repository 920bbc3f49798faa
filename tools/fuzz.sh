#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Fuzzes the readers of what others write with libFuzzer, under address and undefined-behaviour
# sanitizers. Usage: tools/fuzz.sh [--seconds N | --runs [N]] [READER...]
#   --seconds N  for each reader (60)
#   --runs [N]   N inputs for each reader instead; without N a million of binary readers, 100000 of
#                readers of text
#   READER       a folder of tests/fuzz/corpus; all without it
# Starts from that folder, from files of ours of that kind, and from what earlier calls have gathered in
# build/fuzz/corpus. Prints a line a reader; exit status 1 if anything was found. What was found stands in
# build/fuzz/found: mend it and keep it in tests/fuzz/corpus, which every build reads.
set -euo pipefail
cd "$(dirname "$0")/.."
usage() { sed -n 's/^# \?//p' "$0" | sed -n 3,12p; exit "$1"; }
seconds=60 runs=
while [[ "${1:-}" == -* ]]; do
  case $1 in
    --seconds) seconds=${2:-} && shift ;;
    --runs) runs=each; [[ "${2:-}" =~ ^[0-9]+$ ]] && runs=$2 && shift ;;
    --help) usage 0 ;;
    *) usage 64 >&2 ;;
  esac
  shift
done
[[ "$seconds" =~ ^[1-9][0-9]*$ ]] || usage 64 >&2
readers=("$@")
[ $# -gt 0 ] || mapfile -t readers < <(ls tests/fuzz/corpus)

EXTRA_PACKAGES="clang" tools/setup.sh clang oca_fuzz
fuzzer=$PWD/$(find build/clang -type f -name oca_fuzz -perm -u+x)
mkdir -p build/fuzz/found

gather() { # READER FOLDER: files of ours that it reads
  case $1 in
    document | diagram) find diagrams tests -name '*.yaml' -size -16k ;;
    csv) find docs models tests -name '*.csv' -size -16k ;;
    urdf) find models tests -name '*.urdf' -size -16k ;;
    srdf) find models tests -name '*.srdf' -size -16k ;;
  esac | while read -r file; do cp "$file" "$2/$(tr / _ <<< "$file")"; done
}

limit() { # READER: how long it is fuzzed
  [ -n "$runs" ] || { echo "-max_total_time=$seconds"; return; }
  [ "$runs" = each ] || { echo "-runs=$runs"; return; }
  OCA_FUZZ_READER=list "$fuzzer" | sed -n "s/^$1 /-runs=/p"
}

found=0
for reader in "${readers[@]}"; do
  [ -d "tests/fuzz/corpus/$reader" ] || { echo "no such reader: $reader" >&2; exit 64; }
  corpus=build/fuzz/corpus/$reader
  mkdir -p "$corpus"
  gather "$reader" "$corpus"
  log=build/fuzz/$reader.log
  status=0
  OCA_FUZZ_READER=$reader TMPDIR=/dev/shm "$fuzzer" "$(limit "$reader")" -timeout=10 -rss_limit_mb=2048 -max_len=32768 \
    -artifact_prefix="build/fuzz/found/$reader-" "$corpus" "tests/fuzz/corpus/$reader" > "$log" 2>&1 || status=$?
  runs_of=$(awk '/^#[0-9]+/ { runs = substr($1, 2); for (i = 2; i < NF; ++i) if ($i == "cov:") covered = $(i + 1) }
                 END { printf "%d inputs, %d branches", runs, covered }' "$log")
  if [ $status -eq 0 ]; then
    echo "pass  $reader: $runs_of"
  else
    found=1
    echo "FOUND $reader: $runs_of; see $log"
    grep -E 'SUMMARY|runtime error|Test unit written|terminate called|what\(\)' "$log" | sed 's/^/        /' || true
  fi
done
exit $found
