# A full or closed terminal loses messages, no run and no record.
run="$SIMULATOR run $OCA_SOURCE/diagrams/static_test.yaml -t 3 --no-progress --log-level info"
expect() {  # STATUS GOT WHAT
  [ "$1" = "$2" ] || { echo "$3: status $2, expected $1"; exit 1; }
}
whole() {
  "$SIMULATOR" compare a.mcap "$1" > difference || { echo "$2: another record"; cat difference; exit 1; }
}
s=0; $run --record a.mcap > out 2> err || s=$?; expect 3 $s plain
s=0; $run --record b.mcap > out 2> /dev/full || s=$?; expect 3 $s full; whole b.mcap full
s=0; $run --record c.mcap > out 2>&- || s=$?; expect 3 $s closed; whole c.mcap closed
s=0; $run --record d.mcap --json > /dev/full 2> err || s=$?; expect 1 $s 'full output'; whole d.mcap 'full output'
s=0; $run --record e.mcap --json >&- 2>&- <&- || s=$?; expect 1 $s 'all closed'; whole e.mcap 'all closed'
s=0; { $run --record f.mcap --json 2> err || echo $? > status; } | true; expect 1 "$(cat status)" 'a pipe'; whole f.mcap 'a pipe'
s=0; "$SIMULATOR" frobnicate 2>&- || s=$?; expect 64 $s usage
s=0; "$SIMULATOR" run none.yaml 2> /dev/full || s=$?; expect 2 $s 'no file'
# A file that may grow no more, and no folder for temporary files, are told like any mistake.
s=0; (ulimit -f 1; $run --record g.mcap > out 2> err) || s=$?; expect 1 $s 'a file at its limit'; grep -q 'g.mcap: could not be written' err
s=0; TMPDIR=$PWD/none "$SIMULATOR" run a.mcap 2> err || s=$?; expect 2 $s 'no temporary folder'; grep -q '^TMPDIR: got .*/none; expected' err
