# Headers whose products pass 32 bits: refused with the file, no crash, no memory for what is not there.
head -c 4096 /dev/zero > zeros
repeat() { printf "$1%.0s" $(seq "$2"); }
pcd() {  # NAME FIELDS SIZES TYPES COUNTS
  { echo "FIELDS $2"; echo "SIZE $3"; echo "TYPE $4"; echo "COUNT $5"; printf 'POINTS 1\nDATA binary\n'; cat zeros; } > "$1"
}
many=53688  # times 8 times 10000 bytes: 2^32 and a little
pcd low.pcd "$(repeat 'a ' $many) x y z" "$(repeat '8 ' $many) 4 4 4" "$(repeat 'U ' $many) F F F" "$(repeat '10000 ' $many) 1 1 1"
pcd high.pcd "x y z $(repeat 'a ' $many)" "4 4 4 $(repeat '8 ' $many)" "F F F $(repeat 'U ' $many)" "1 1 1 $(repeat '10000 ' $many)"
pcd count.pcd 'x y z a' '4 4 4 8' 'F F F U' '1 1 1 18446744073709551615'
printf 'P5 65536 65536 255\n' > big.pgm
printf 'P5 10000 10000 65535\n' > wide.pgm
{ head -c 80 /dev/zero; printf '\x00\x00\x00\x80'; } > many.stl  # 2^31 triangles: 25 * 2^32 bytes
printf '# Octomap OcTree binary file\nsize 1e300\nres 0.1\ndata\n' > nodes.bt
try() {  # FILE SHAPE
  echo "systems: {o: {type: ObstacleSource, obstacles: [{id: a, pose: {xyz: [0, 0, 0]}, shape: {file: $1, $2}}]}}" > d.yaml
  status=0
  (ulimit -v 2000000; "$SIMULATOR" check d.yaml > /dev/null 2> err) || status=$?
  [ $status = 2 ] && grep -q "$1.*; got .*; expected" err && return
  echo "$1: status $status"; cat err; exit 1
}
for file in low high count; do try $file.pcd 'type: cloud, radius: 0.1'; done
for file in big wide; do try $file.pgm 'type: heightmap, cell: 0.1, scale: 1'; done
try many.stl 'type: mesh'
try nodes.bt 'type: octree'
