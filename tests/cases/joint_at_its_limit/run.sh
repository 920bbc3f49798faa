# A slider at one of its limits, a little inside, and beyond, is asked back inside, in every method,
# with and without a jerk limit: it arrives. Once it stood for ever.
cp "$CASE"/*.urdf "$CASE"/*.yaml .
ln -s "$OCA_SOURCE/diagrams/parts" parts
sed 's/ jerk="60"//' arm.urdf > smooth.urdf
status=0
arrives() { # START URDF METHOD
  if ! "$SIMULATOR" run open.yaml --no-progress -s parameters.start="$1" \
      -s models.arm.urdf="$2" -s parameters.avoidance="$3" > out 2>&1; then
    echo "from $1 with $2 by $3:"
    cat out
    status=1
  fi
}
for method in "$OCA_SOURCE"/diagrams/parts/avoidance_*.yaml; do
  method=${method##*/avoidance_}
  for start in -0.01 -0.0099999999999 -0.0100000000001 -0.02 -1 0.07 0.0699999999999 0.08 1; do
    arrives "$start" arm.urdf "${method%.yaml}"
  done
  arrives -0.01 smooth.urdf "${method%.yaml}"
  arrives 0.08 smooth.urdf "${method%.yaml}"
done
exit $status
