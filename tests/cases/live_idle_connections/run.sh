# Sockets that ask for nothing keep nobody out of a live run or a record that is shown; Ctrl-C ends
# both with 130, as any run.
"$SIMULATOR" run "$OCA_SOURCE/diagrams/verification/lag_step.yaml" -t 0.1 --record run.mcap --no-progress > /dev/null || true
cat > ask.py <<'PY'
import re, signal, socket, subprocess, sys
upgrade = ('GET / HTTP/1.1\r\nHost: localhost\r\nConnection: Upgrade\r\nUpgrade: websocket\r\n'
           'Sec-WebSocket-Version: 13\r\nSec-WebSocket-Key: AAAAAAAAAAAAAAAAAAAAAA==\r\n\r\n')
def ask(port, text):
    s = socket.create_connection(('127.0.0.1', port), 10)
    s.sendall(text.encode())
    return s, s.recv(15)
process = subprocess.Popen(sys.argv[1:], stdout=subprocess.PIPE, text=True)
port = int(re.search(r'127\.0\.0\.1:(\d+)/', process.stdout.readline()).group(1))
idle = [socket.create_connection(('127.0.0.1', port), 10) for _ in range(200)]
for s in idle[::3]: s.sendall(b'GET / HTT')
silent = [ask(port, upgrade)[0] for _ in range(100)]
for answer, request in (('200', 'GET / HTTP/1.1\r\nHost: localhost\r\n\r\n'), ('101', upgrade)):
    got = ask(port, request)[1]
    assert got.split()[1] == answer.encode(), (request, got)
process.send_signal(signal.SIGINT)
status = process.wait(20)
assert status == 130, status
PY
python3 ask.py "$SIMULATOR" run "$OCA_SOURCE/diagrams/static_test.yaml" --live=0 --no-progress
if "$SIMULATOR" view run.mcap --address nowhere 2>&1 | grep -q 'viewer page'; then
  echo "no viewer page: view is not tried"
else
  python3 ask.py "$SIMULATOR" view run.mcap --port 0
fi
