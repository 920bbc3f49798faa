# Meshes all of whose vertices are corners of their hull: four times the triangles take about four
# times as long, on a ball and on two rims alike; the best of three, of the processor's time.
cat > make.py <<'PY'
import math, struct, sys
kind, n = sys.argv[1], int(sys.argv[2])
triangles = []
if kind == 'ball':
    m = 2 * n
    def at(i, j):
        a, b = math.pi * i / n, 2 * math.pi * j / m
        return math.sin(a) * math.cos(b), math.sin(a) * math.sin(b), math.cos(a)
    for i in range(n):
        for j in range(m):
            a, b, c, d = at(i, j), at(i + 1, j), at(i + 1, (j + 1) % m), at(i, (j + 1) % m)
            if i < n - 1: triangles.append((a, b, c))
            if i > 0: triangles.append((a, c, d))
else:
    n = n * n
    def at(i, z):
        a = 2 * math.pi * i / n
        return math.cos(a), 0.8 * math.sin(a) - 0.6 * z, 0.6 * math.sin(a) + 0.8 * z
    for i in range(n):
        triangles += [(at(i, 0), at(i + 1, 0), at(i + 1, 1)), (at(i, 0), at(i + 1, 1), at(i, 1)),
                      (at(0, 0), at(i + 1, 0), at(i, 0)), (at(0, 1), at(i, 1), at(i + 1, 1))]
with open('body.stl', 'wb') as file:
    file.write(bytes(80) + struct.pack('<I', len(triangles)))
    for t in triangles:
        file.write(struct.pack('<12fH', 0, 0, 0, *[x for p in t for x in p], 0))
print(len(triangles))
PY
echo '<robot name="s"><link name="a"><collision><geometry><mesh filename="body.stl"/></geometry></collision></link></robot>' > s.urdf
seconds() {
  TIMEFORMAT=%U
  for _ in 1 2 3; do
    { time "$SIMULATOR" robot check-collisions s.urdf --samples 1 > /dev/null 2> err; } 2> time
    cat time
  done | sort -n | head -1
}
for kind in ball rims; do
  few=$(python3 make.py $kind 80) && fast=$(seconds)
  many=$(python3 make.py $kind 160) && slow=$(seconds)
  echo "$kind: $few triangles $fast s, $many triangles $slow s"
  awk "BEGIN { exit !($slow < 8 * ($fast + 0.01)) }"
done
