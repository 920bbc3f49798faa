# Maps and clouds of many cells: within their bounds they take hundreds of megabytes, beyond they are
# refused by name; nobody reads of std::bad_alloc.
python3 - <<'PY'
import random, struct
random.seed(1)
open('row.csv', 'w').write('0,1,' * 3000000)                   # 6 million cells in a row
open('rows.csv', 'w').write(('0,0.5,' * 1500 + '0\n') * 1000)  # 3 million boxes
open('noise.pgm', 'wb').write(b'P5 5000 5000 255\n' + random.randbytes(25000000))
open('flat.pgm', 'wb').write(b'P5 5000 5000 255\n' + bytes(25000000))
open('wide.pgm', 'wb').write(b'P5 4294967297 4294967297 255\nx')
open('negative.pgm', 'wb').write(b'P2 -5 3 255\n1 2 3\n')
for name, count in (('million', 1000000), ('more', 1000001)):
    head = 'FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nPOINTS %d\nDATA binary\n' % count
    points = struct.pack('<%df' % (3 * count), *[random.random() for _ in range(3 * count)])
    open(name + '.pcd', 'wb').write(head.encode() + points)
packed = struct.pack('<II', 6, 12 * 8000000) + b'\x00a\xe0\xff\x00\x00'  # 96 MB of 6 bytes
head = 'FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nPOINTS 8000000\nDATA binary_compressed\n'
open('packed.pcd', 'wb').write(head.encode() + packed)
head = 'ply\nformat binary_big_endian 1.0\nelement vertex 10000000\nproperty float x\n' \
       'property float y\nproperty float z\nelement face 10000000\n' \
       'property list uchar int vertex_indices\nend_header\n'
open('big.ply', 'wb').write(head.encode() + bytes(120))
PY
try() {  # STATUS FILE SHAPE
  echo "systems: {o: {type: ObstacleSource, obstacles: [{id: a, pose: {xyz: [0, 0, 0]}, shape: {file: $2, $3}}]}}" > d.yaml
  status=0
  (ulimit -v 1500000; "$SIMULATOR" check d.yaml > out 2> err) || status=$?
  cat err
  [ $status = "$1" ]
  if [ "$1" = 2 ]; then grep -q "$2.*; got .*; expected" err; fi
  if grep -q bad_alloc err; then exit 1; fi
}
map='type: heightmap, cell: 0.05, scale: 1' cloud='type: cloud, radius: 0.01'
try 2 row.csv "$map"
try 2 rows.csv "$map"
try 2 noise.pgm "$map"
try 0 flat.pgm "$map"
try 2 wide.pgm "$map"
try 2 negative.pgm "$map"
try 0 million.pcd "$cloud"
try 2 more.pcd "$cloud"
try 2 packed.pcd "$cloud"
try 2 big.ply "$cloud"
try 2 big.ply 'type: mesh'
