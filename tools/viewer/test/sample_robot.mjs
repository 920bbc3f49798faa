// SPDX-License-Identifier: BSD-3-Clause
// Records of robots that stand still, by docs/reference/record_format.md, without any simulator.
import { colour, identity, pose, recordOf, vector } from "./sample_record.mjs";

/** Names that nobody is glad of: each must be shown as it is. */
export const kHostile = ["</script><img src=x onerror=alert(1)>", "\"quotes' & <b>bold</b>", "рука ✋ ‮back", "__proto__"];

const at = (xyz, quaternion = [0, 0, 0, 1]) => ({ xyz, quaternion });
const link = (name, collisions = [], visuals = []) => ({ name, frame: `r/${name}`, mass: 1, visuals, collisions });
const none = { mimics: null, lower: null, upper: null, velocity: null, effort: null, acceleration: null };
const joint = (name, type, parent, child, origin, axis, position, more = {}) =>
  ({ name, type, parent, child, origin, axis, position, multiplier: position === null ? 0 : 1, offset: 0, ...none, ...more });
const slider = (name, unit, range) => ({ joint: name, unit, start: 0, lower: range[0], upper: range[1], range });
const kQuarter = [Math.SQRT1_2, 0, 0, Math.SQRT1_2];  // about x

/** "one" turns about z at 0.3 m, "two" slides outward at 0.2 m from it, "three" is fixed above, turned about x, and "four" turns
    back about that y, which is the world's z, as far as "one" turns. */
export const turner = {
  name: kHostile[0], file: "turner.urdf", srdf: null, base: at([0, 0, 0]),
  links: [link(kHostile[1], ["box"], ["box"]), link(kHostile[2], ["sphere"]), link(kHostile[3], ["box"]), link("three"), link("four", ["sphere"], ["sphere"])],
  joints: [
    joint(kHostile[1], "revolute", 0, 1, at([0, 0, 0.3]), [0, 0, 1], 0, { lower: -2, upper: 2, velocity: 1.5, effort: 20 }),
    joint("slide", "prismatic", 1, 2, at([0.2, 0, 0]), [1, 0, 0], 1, { lower: -0.1, upper: 0.4 }),
    joint("bracket", "fixed", 2, 3, at([0, 0, 0.1], kQuarter), [1, 0, 0], null),
    joint("back", "revolute", 3, 4, at([0, 0.1, 0]), [0, 1, 0], 0, { multiplier: -1, offset: 0.5, mimics: kHostile[1] }),
  ],
  positions: [slider(kHostile[1], "rad", [-2, 2]), slider("slide", "m", [-0.1, 0.4])],
  own_pairs: [[0, 2], [1, 2], [1, 4]], disabled_pairs: 0,
  warnings: [{ text: `link '${kHostile[2]}': <i>thin</i>`, links: [1] }, { text: "of no link", links: [] }],
};
/** Where its links are, by hand: positions in m, quaternions x, y, z, w. */
export function turnerPoses([angle, slide]) {
  const [c, s] = [Math.cos(angle), Math.sin(angle)], about = [0, 0, Math.sin(angle / 2), Math.cos(angle / 2)];
  const [x, y] = [c * (0.2 + slide), s * (0.2 + slide)];
  // A turn about z after the quarter about x, and the quarter after a turn of "four" about y: z again.
  const turned = (half) => [Math.SQRT1_2 * Math.cos(half), Math.SQRT1_2 * Math.sin(half), Math.SQRT1_2 * Math.sin(half), Math.SQRT1_2 * Math.cos(half)];
  return [[0, 0, 0, 0, 0, 0, 1], [0, 0, 0.3, ...about], [x, y, 0.3, ...about], [x, y, 0.4, ...turned(angle / 2)], [x, y, 0.5, ...turned(0.25)]];
}

const cube = (size) => ({ cubes: [{ pose: pose([0, 0, 0]), size: vector(size), color: colour(0.9, 0.5, 0.1) }] });
const ball = (radius) => ({ spheres: [{ pose: pose([0, 0, 0]), size: vector([2 * radius, 2 * radius, 2 * radius]), color: colour(0.9, 0.5, 0.1) }] });

/** A box as binary STL, in base64. */
function boxStl(size) {
  const corners = [0, 1, 2, 3, 4, 5, 6, 7].map((k) => size.map((edge, axis) => (k >> axis & 1 ? edge : -edge) / 2));
  const faces = [[0, 2, 1], [1, 2, 3], [4, 5, 6], [5, 7, 6], [0, 1, 4], [1, 5, 4], [2, 6, 3], [3, 6, 7], [0, 4, 2], [2, 4, 6], [1, 3, 5], [3, 7, 5]];
  const bytes = Buffer.alloc(84 + 50 * faces.length, " ");
  bytes.writeUInt32LE(faces.length, 80);
  faces.forEach((face, i) => [[0, 0, 0], ...face.map((k) => corners[k]), ].flat().forEach((x, k) => bytes.writeFloatLE(x, 84 + 50 * i + 4 * k)));
  return bytes.toString("base64");
}

const unit = (k) => [0, 1, 2].map((i) => (i === k ? 1 : 0));
export const kFloater = { still: [0.4, 0.3, 0.2], moving: [0.2, 0.1, 0.3] };
/** A box at rest, and a mesh of a box that floats: six joints, which slide and then turn about x, y and z. */
export const floater = {
  name: "floater", file: "floater.urdf", srdf: "floater.srdf", base: at([0, 0, 0]),
  links: [link("still", ["box"]), ...[1, 2, 3, 4, 5].map((k) => link(`frame ${k}`)), link("moving", ["hull of 8 corners"])],
  joints: [0, 1, 2, 3, 4, 5].map((k) => joint(`j${k}`, k < 3 ? "prismatic" : "continuous", k, k + 1, at([0, 0, 0]), unit(k % 3), k)),
  positions: [0, 1, 2, 3, 4, 5].map((k) => slider(`j${k}`, k < 3 ? "m" : "rad", k < 3 ? [-0.4, 0.4] : [-3, 3])),
  own_pairs: [[0, 6]], disabled_pairs: 3, warnings: [],
};
const mesh = (size) => ({ models: [{ pose: pose([0, 0, 0]), scale: vector([1, 1, 1]), color: colour(0.9, 0.5, 0.1), media_type: "model/stl", data: boxStl(size) }] });

function entities(robot, solids, prefix) {
  return { deletions: [], entities: robot.links.map(({ frame }, i) => ({ id: prefix + frame, frame_id: frame, ...solids[i] })) };
}

function robotRecord(robot, visuals, collisions) {
  return recordOf(async (put) => {
    const transforms = robot.links.map(({ frame }) => ({ parent_frame_id: "world", child_frame_id: frame, translation: vector([0, 0, 0]), rotation: identity }));
    await put("/tf", "foxglove.FrameTransforms", 0, { transforms });
    await put("/scene/robots", "foxglove.SceneUpdate", 0, entities(robot, visuals, ""));
    await put("/scene/collisions", "foxglove.SceneUpdate", 0, entities(robot, collisions, "collision/"));
    await put("/robot", "oca.Robot", 0, robot);
  });
}

export const turnerRecord = () => robotRecord(turner, [cube([0.3, 0.3, 0.1]), {}, {}, {}, ball(0.06)],
                                              [cube([0.3, 0.3, 0.1]), ball(0.1), cube([0.1, 0.1, 0.1]), {}, ball(0.06)]);
export const floaterRecord = () => robotRecord(floater, [], [cube(kFloater.still), {}, {}, {}, {}, {}, mesh(kFloater.moving)]);
