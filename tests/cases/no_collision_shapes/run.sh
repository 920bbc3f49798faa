# A robot of which distances see nothing is not clear of a box that it swings through.
cp "$CASE"/*.urdf "$CASE"/tool.obj "$CASE"/arm.yaml .
ln -s "$OCA_SOURCE" source
status() { local s=0; "$@" > out 2> err || s=$?; echo "$s"; }
has() { grep -q -e "$1" "$2" || { echo "no '$1' in:"; cat "$2"; exit 1; }; }
lacks() { ! grep -q -e "$1" "$2" || { echo "'$1' in:"; cat "$2"; exit 1; }; }

for command in check run plan; do
  [ "$(status "$SIMULATOR" $command arm.yaml)" = 2 ]
  has "got 'arm', which cannot avoid anything: robot 'drawn' has no collision shape on any movable" err
  has 'upper, tool; models.arm.visual_as_collision: missing' err
done

# Seen by half: clear of what it sees only.
[ "$(status "$SIMULATOR" check arm.yaml -s parameters.robot=half.urdf)" = 0 ]
has 'warning: models.arm: a link is drawn without a collision shape.*: tool;' err
[ "$(status "$SIMULATOR" run arm.yaml -s parameters.robot=half.urdf)" = 0 ]
has 'clear' out
has 'not seen  *links without a collision shape: tool$' out
lacks 'tip' out

# What is drawn may collide, and then no warning is left.
[ "$(status "$SIMULATOR" run arm.yaml -s models.arm.visual_as_collision=missing)" = 0 ]
has 'clear: nearest 0.0' out
lacks 'not seen' out
lacks 'warning' err

# Nothing there: nothing is known, and who expects no contact is told.
[ "$(status "$SIMULATOR" run arm.yaml -s parameters.robot=half.urdf -s 'systems.obstacles.obstacles=[]')" = 0 ]
has 'NOT KNOWN' out
lacks 'at every time' out
sed 's|^simulator:|expect: {contact_time: {equal: 0}}\n&|' arm.yaml > expecting.yaml
[ "$(status "$SIMULATOR" run expecting.yaml -s parameters.robot=half.urdf -s 'systems.obstacles.obstacles=[]')" = 3 ]
[ "$(status "$SIMULATOR" sweep arm.yaml --samples 2 --seed 1 -o swept -s parameters.robot=half.urdf \
  -s 'systems.obstacles.obstacles=[]' --json)" = 0 ]
has '"clear": null' out
has 'distances do not see it: tool' err

# The table of a robot's pairs says so too.
[ "$(status "$SIMULATOR" robot check-collisions arm.urdf --samples 10)" = 0 ]
has 'no collision shape on any movable link' err
has '--visual-as-collision missing takes what is drawn' err
[ "$(status "$SIMULATOR" robot check-collisions arm.urdf --samples 10 --visual-as-collision missing)" = 0 ]
has '1 pairs of links' out
lacks 'warning' err
