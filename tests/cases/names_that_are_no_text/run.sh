# Files and folders whose names are no UTF-8, or hold what a terminal obeys: they run, record and run
# again, JSON of them is JSON, and nothing that is printed is obeyed. Names in files are UTF-8.
esc=$'\e' bell=$'\a'
folder=$'d\xe9p\xf4t' name=$'caf\xe9.yaml' wild="${esc}[2J${bell}"$'\x9b.yaml'
mkdir "$folder"
cp -r "$OCA_SOURCE/diagrams/parts" "$OCA_SOURCE"/diagrams/*.yaml .
sed '/^name:/d' static_test.yaml > "$name"
cp "$name" "$wild"
sed 's|include: \[parts/|include: [../parts/|' "$name" > "$folder/$name"
harmless() {  # FILE...: valid UTF-8 without control characters but ends of lines and tabs
  python3 -c '
import sys
for name in sys.argv[1:]:
    text = open(name, "rb").read().decode()
    bad = [c for c in text if (ord(c) < 32 and c not in "\n\t") or 127 <= ord(c) < 160]
    assert not bad, (name, bad)
' "$@"
}
run() { "$SIMULATOR" "$@" > out 2> err || { echo "$*: exit $?"; cat out err; exit 1; }; harmless out err; }
status() { local s=0; "$SIMULATOR" "$@" > out 2> err || s=$?; harmless out err; echo $s; }

for file in "$name" "$wild" "$folder/$name"; do
  run check "$file"
  run run "$file" -t 0.1 --json -s expect={}
  python3 -m json.tool out > /dev/null
  run run "$file" -t 0.1 --no-progress -s expect={} --record a.mcap --report a.html --csv table
  cp a.mcap away.mcap
  mkdir empty && cd empty
  run run ../away.mcap -t 0.1 --no-progress --record b.mcap
  run compare ../away.mcap b.mcap
  run run ../away.mcap -t 0.1 --no-progress -s parameters.avoidance=safety_filter
  run export b.mcap --csv exported
  cd .. && rm -r empty table
done

# A live run of them answers, and ends as it should.
"$SIMULATOR" run "$wild" --live=0 --no-progress -t 0.2 > out 2> err
harmless out err

# What is refused is refused in printable words, whatever it is.
[ "$(status run "$esc]0;title$bell")" = 2 ]
[ "$(status run "$name" -s "parameters.$esc[31m=1")" = 2 ]
[ "$(status run "$name" -s $'parameters.avoidance="\xe9"')" = 2 ]
[ "$(status "$esc[31mrun")" = 64 ]
[ "$(status run "$name" "--$esc[31m")" = 64 ]
[ "$(status describe "$esc[31m")" = 2 ]
[ "$(status view "$wild")" = 2 ]
printf '<robot name="caf\xe9"><link name="a"/></robot>' > latin.urdf
[ "$(status robot check-collisions latin.urdf)" = 2 ]
grep -q 'latin.urdf:1: XML; got binary data, or text of another encoding; expected' err
printf '<robot name="a\e[31m"><link name="a"/></robot>' > red.urdf
[ "$(status robot check-collisions red.urdf)" = 2 ]
printf '{"in": [1]}\n{"\xe9": [1]}\n{"in": ["\x1b"]}\n' | "$SIMULATOR" eval Gain --params '{"gain": 2}' > lines
harmless lines
while read -r line; do python3 -m json.tool <<< "$line" > /dev/null; done < lines
[ "$(grep -c error lines)" = 2 ]
