# A page of any origin, or of any name that leads here (DNS rebinding), must not reach a live run
# or a record that is shown: neither the page, nor the record, nor the WebSocket that changes the run.
pids=()
trap 'kill "${pids[@]}" 2> /dev/null || true' EXIT

# serve OUT ARGUMENT...: starts the simulator; sets `url` and `port` when it says where it is.
serve() {
  local out=$1
  shift
  "$SIMULATOR" "$@" > "$out" 2> "$out.err" &
  pids+=($!)
  url=
  for _ in $(seq 200); do
    url=$(grep -o 'http://[^ ]*' "$out" || true)
    [ -n "$url" ] && break
    sleep 0.05
  done
  [ -n "$url" ] || { cat "$out.err"; exit 1; }
  port=$(sed 's|.*:\([0-9]*\)/.*|\1|' <<< "$url")
}

upgrade='Connection: Upgrade\r\nUpgrade: websocket\r\nSec-WebSocket-Version: 13\r\nSec-WebSocket-Key: AAAAAAAAAAAAAAAAAAAAAA==\r\nSec-WebSocket-Protocol: foxglove.websocket.v1\r\n'

# expect STATUS TARGET HEADERS: what a request is answered.
expect() {
  local line
  exec 3<> "/dev/tcp/127.0.0.1/$port"
  printf "GET $2 HTTP/1.1\r\n$3\r\n" >&3
  read -r -t 10 line <&3
  exec 3>&-
  [[ $line == "HTTP/1.1 $1 "* ]] || { echo "GET $2 with $3: expected $1; got $line"; failed=1; }
}

failed=0
serve live run "$CASE/ball.yaml" --live=0 --no-progress
own="Host: 127.0.0.1:$port\r\n"
expect 200 / "$own"
expect 101 / "$own$upgrade"
expect 101 / "${own}Origin: http://127.0.0.1:$port\r\n$upgrade"
expect 403 / "${own}Origin: https://evil.example\r\n$upgrade"
expect 403 / "${own}Origin: null\r\n$upgrade"
expect 403 / "${own}Origin: https://app.foxglove.dev\r\n$upgrade"
expect 403 / "Host: evil.example\r\n"
expect 403 / "Host: evil.example:$port\r\n$upgrade"
expect 403 / "Host: evil.example\r\nOrigin: https://evil.example\r\n$upgrade"
expect 400 / "$upgrade"
expect 400 / "${own}Host: evil.example\r\n$upgrade"

serve named run "$CASE/ball.yaml" --live=0 --no-progress --live-origin foxglove --live-origin https://tools.example
own="Host: localhost:$port\r\n"
expect 101 / "${own}Origin: https://app.foxglove.dev\r\n$upgrade"
expect 101 / "${own}Origin: https://tools.example\r\n$upgrade"
expect 403 / "${own}Origin: https://evil.example\r\n$upgrade"

"$SIMULATOR" run "$CASE/ball.yaml" -t 0.1 --record run.mcap --no-progress > /dev/null
if "$SIMULATOR" view run.mcap --address nowhere 2>&1 | grep -q 'viewer page'; then
  echo "no viewer page: view is not tried"
else
  serve view view run.mcap --port 0
  own="Host: [::1]:$port\r\n"
  expect 200 /record.mcap "$own"
  expect 403 /record.mcap "Host: evil.example\r\n"
  expect 403 /record.mcap "${own}Origin: https://evil.example\r\n"
fi

# Where others reach it, nothing without the token of the printed address.
serve all run "$CASE/ball.yaml" --live=0 --live-address 0.0.0.0 --no-progress
grep -q '^warning: 0.0.0.0 can be reached from elsewhere' all.err
own="Host: 127.0.0.1:$port\r\n"
token=${url#*\?}
[[ $token =~ ^token=[0-9a-f]{32}$ ]]
expect 200 "/?$token" "$own"
expect 101 "/?$token" "$own$upgrade"
expect 403 / "$own"
expect 403 "/?token=00000000000000000000000000000000" "$own$upgrade"
expect 403 "/?$token" "Host: evil.example\r\n$upgrade"
exit "$failed"
