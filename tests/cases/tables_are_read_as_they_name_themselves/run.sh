# A ball of 0.1 m at the origin beside points that count 0.05 m: 2,0,0 is 1.85 m away, however a
# spreadsheet writes it. What cannot be read for certain is refused with file and line.
cp "$CASE"/* .
try() {  # TEXT WHAT
  printf "$1" > cloud.csv
  rm -rf out
  if ! "$SIMULATOR" run cloud.yaml --no-progress --csv out > /dev/null 2> err; then
    grep -q "cloud.csv:1: .*$2" err || { echo "$1: expected $2"; cat err; exit 1; }
    return
  fi
  got=$(tail -1 out/d.proximities.jsonl | grep -o '"distance":[-0-9.]*' | cut -d: -f2)
  awk -v a="$got" -v b="$2" 'BEGIN { exit !(b + 0 > 0 && (a - b)^2 < 1e-16) }' || { echo "$1: $got, expected $2"; exit 1; }
}
try '\xef\xbb\xbf2,0,0\r\n9,0,0\r\n' 1.85
try 'id,x,y,z\n7,2,0,0\n' 1.85
try 'z;y;x;id\n0;0;2;7\n' 1.85
try '# z y x\n0 0 2\n' 1.85
try '"x","y","z"\n"2","0","0"\n' 1.85
try '2,5;0,1;0,3\n' 'decimal point'
try '2,0,x\n9,0,0\n' "not a number; got 'x'"
try 'x,y,x,z\n2,0,0,0\n' "more than one 'x'"
try '\xff\xfe2\x00,\x00' 'UTF-16'
