# The tables of a run and of its record are one, with as many names as columns, and a file of key
# points that gives the same numbers again.
cp "$CASE"/*.yaml "$CASE"/arm.urdf .
"$SIMULATOR" run d.yaml --no-progress --record d.mcap --csv run > /dev/null
"$SIMULATOR" export d.mcap --csv export > /dev/null
cmp run/spline.position.csv export/spline.position.csv
head -1 run/spline.position.csv | grep -qxF 'time,"elbow, left",time_2,"say ""wrist"""' || { head -1 run/*.csv; exit 1; }
awk -F, 'NR == 3 && $1 != "0.016666667" { print "time", $1; exit 1 }' run/spline.position.csv
cp run/spline.position.csv .
"$SIMULATOR" run again.yaml --no-progress --csv again > /dev/null
tail -n +2 run/spline.position.csv > one
tail -n +2 again/spline.position.csv > two
cmp <(cut -d, -f1 one) <(cut -d, -f1 two)
awk -F, 'NR == FNR { a[NR] = $0; next } { split(a[FNR], b, ","); for (i = 2; i <= 4; ++i) if ((b[i] - $i)^2 > 1e-14) { print; exit 1 } }' one two
