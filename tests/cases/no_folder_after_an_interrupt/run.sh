# SPDX-License-Identifier: BSD-3-Clause
# What a record brings along is put into a folder, which goes whenever the run is interrupted.
export TMPDIR=$PWD/tmp
mkdir tmp
"$SIMULATOR" run "$OCA_SOURCE/diagrams/scenarios/random_moving.yaml" --no-progress -t 0.1 --record r.mcap > /dev/null 2>&1 || true
for signal in INT TERM INT TERM INT TERM; do
  "$SIMULATOR" run r.mcap -t 1000 --no-progress > /dev/null 2>&1 &
  pid=$!
  until ls tmp/oca_record_* > /dev/null 2>&1 || ! kill -0 "$pid" 2> /dev/null; do :; done
  kill -s "$signal" "$pid" 2> /dev/null || true
  status=0
  wait "$pid" || status=$?
  [ "$status" -eq 130 ] || { echo "status $status after SIG$signal"; exit 1; }
  [ -z "$(ls tmp)" ] || { echo "left after SIG$signal: $(ls tmp)"; exit 1; }
done
