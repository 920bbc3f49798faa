// SPDX-License-Identifier: BSD-3-Clause
// A record by docs/reference/record_format.md without any simulator: an arm of seven joints passes a box.
import { McapWriter } from "@mcap/core";

const kEpoch = 1_700_000_000_000_000_000n;  // ns
const kJoints = 7;
const kHeights = [0.31, 0, 0.4, 0, 0.39, 0, 0.16];  // m to the next joint, along the arm
const kBox = { id: "box", at: [0.45, 0.45, 1.0], size: 0.2 };
export const identity = { x: 0, y: 0, z: 0, w: 1 };
export const vector = ([x, y, z]) => ({ x, y, z });
export const pose = (position, orientation = identity) => ({ position: vector(position), orientation });
export const colour = (r, g, b, a = 1) => ({ r, g, b, a });

/** Joint angles (rad) at time t (s): the test compares the page's plots with these. */
export const requested = (t) => Array.from({ length: kJoints }, (_, i) => (i === 0 ? 1.4 * Math.sin(0.25 * t) : 0.3 + 0.5 * Math.sin(0.2 * t + i)));
export const delta = (t) => Array.from({ length: kJoints }, (_, i) => 0.3 * Math.exp(-((t - 5) ** 2)) * Math.cos(i));
export const final = (t) => requested(t).map((value, i) => value + delta(t)[i]);

function multiply(a, b) {
  return {
    x: a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y, y: a.w * b.y - a.x * b.z + a.y * b.w + a.z * b.x,
    z: a.w * b.z + a.x * b.y - a.y * b.x + a.z * b.w, w: a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z,
  };
}
function rotate(q, v) {
  const p = multiply(multiply(q, { x: v[0], y: v[1], z: v[2], w: 0 }), { x: -q.x, y: -q.y, z: -q.z, w: q.w });
  return [p.x, p.y, p.z];
}

/** Poses of the links: joints turn about z and y by turns. */
function links(q) {
  let at = [0, 0, 0.2], turn = identity;
  return q.map((angle, i) => {
    const [s, c] = [Math.sin(angle / 2), Math.cos(angle / 2)];
    turn = multiply(turn, i % 2 ? { x: 0, y: s, z: 0, w: c } : { x: 0, y: 0, z: s, w: c });
    const link = { at, turn };
    at = at.map((value, k) => value + rotate(turn, [0, 0, kHeights[i]])[k]);
    return link;
  });
}

function robotEntities() {
  return kHeights.map((height, i) => {
    const length = Math.max(height, 0.02);
    const shade = i % 2 ? colour(0.93, 0.5, 0.1) : colour(0.82, 0.84, 0.87);
    const sphere = (z) => ({ pose: pose([0, 0, z]), size: vector([0.14, 0.14, 0.14]), color: shade });
    return { timestamp: stamp(0), frame_id: `arm/link_${i}`, id: `arm/link_${i}`, lifetime: { sec: 0, nsec: 0 }, frame_locked: true,
             metadata: [], arrows: [], cubes: [], lines: [], triangles: [], texts: [], models: [], spheres: [sphere(0), sphere(length)],
             cylinders: [{ pose: pose([0, 0, length / 2]), size: vector([0.14, 0.14, length]), bottom_scale: 1, top_scale: 1, color: shade }] };
  });
}

function stamp(t) {
  const ns = kEpoch + BigInt(Math.round(t * 1e9));
  return { sec: Number(ns / 1_000_000_000n), nsec: Number(ns % 1_000_000_000n) };
}

function forces(now, t) {
  const ends = now.slice(2).map((link) => link.at);
  const lines = [], colors = [], arrows = [], torques = [];
  const proximities = [];
  ends.forEach((from, i) => {
    const to = from.map((value, k) => Math.min(kBox.at[k] + kBox.size / 2, Math.max(kBox.at[k] - kBox.size / 2, value)));
    const distance = Math.hypot(...from.map((value, k) => value - to[k]));
    proximities.push({ link: `link_${i + 2}`, obstacle: kBox.id, distance, point_on_link: from, point_on_obstacle: to, normal: [0, 0, 1] });
    lines.push(vector(from), vector(to));
    const near = Math.max(0, 1 - distance);
    colors.push(colour(near, 1 - near, 0.1), colour(near, 1 - near, 0.1));
    if (distance < 0.45) {
      const size = { shaft_length: 0.25 - 0.3 * distance, shaft_diameter: 0.022, head_length: 0.06, head_diameter: 0.05 };
      arrows.push({ pose: pose(from, { x: 0, y: -Math.SQRT1_2, z: 0, w: Math.SQRT1_2 }), ...size, color: colour(0.88, 0.2, 0.17) });
      torques.push({ pose: pose(from, { x: 0, y: 0, z: Math.SQRT1_2, w: Math.SQRT1_2 }), ...size, color: colour(0.9, 0.7, 0) });
    }
  });
  const base = { timestamp: stamp(t), frame_id: "world", lifetime: { sec: 0, nsec: 0 }, frame_locked: false, metadata: [] };
  const metadata = [{ key: "distances", value: JSON.stringify(proximities.map(({ distance }) => distance)) }];
  return { proximities, update: { deletions: [], entities: [
    { ...base, id: "distances", metadata, lines: [{ type: 2, pose: pose([0, 0, 0]), thickness: 2, scale_invariant: true, points: lines, color: colour(0, 0, 0), colors, indices: [] }] },
    { ...base, id: "forces", arrows }, { ...base, id: "torques", arrows: torques }] } };
}

/** The bytes of a record that `fill` puts messages and metadata into. */
export async function recordOf(fill) {
  const parts = [];
  let size = 0, sequence = 0;
  const writer = new McapWriter({ writable: {
    write: async (bytes) => { parts.push(Uint8Array.from(bytes)); size += bytes.length; }, position: () => BigInt(size) } });
  await writer.start({ profile: "", library: "oca" });
  const channels = new Map();
  async function put(topic, schemaName, t, message, schema = { type: "object" }) {
    if (!channels.has(topic)) {
      const schemaId = await writer.registerSchema({ name: schemaName, encoding: "jsonschema", data: Buffer.from(JSON.stringify(schema)) });
      channels.set(topic, await writer.registerChannel({ topic, schemaId, messageEncoding: "json", metadata: new Map() }));
    }
    const time = kEpoch + BigInt(Math.round(t * 1e9));
    await writer.addMessage({ channelId: channels.get(topic), sequence: sequence++, logTime: time, publishTime: time, data: Buffer.from(JSON.stringify(message)) });
  }
  await fill(put, (name, metadata) => writer.addMetadata({ name, metadata: new Map(Object.entries(metadata)) }));
  await writer.end();
  return Buffer.concat(parts);
}

/** The bytes of a record of `duration` s: scene at 60 Hz, signals at 100 Hz. */
export const sampleRecord = (duration = 10) => recordOf((put, describe) => fillSample(put, describe, duration));

async function fillSample(put, describe, duration) {
  await describe("oca", { version: "0.1.0", diagram: "sample.yaml", seed: "42", start_epoch_ns: String(kEpoch), dropped_messages: "0", outcome: "finished" });
  await describe("oca.parameters", { max_distance: "0.3", max_joint_velocity: "0.6", alpha: "1" });
  const named = (values) => Object.fromEntries(values.map((value, i) => [`a${i + 1}`, value]));
  const jointSchema = { type: "object", properties: Object.fromEntries(requested(0).map((_, i) => [`a${i + 1}`, { type: "number", "x-unit": "rad" }])) };
  await put("/scene/robots", "foxglove.SceneUpdate", 0, { deletions: [], entities: robotEntities() });
  await put("/scene/obstacles", "foxglove.SceneUpdate", 0, { deletions: [], entities: [{ timestamp: stamp(0), frame_id: "obstacle/box", id: "box", frame_locked: true,
    cubes: [{ pose: pose([0, 0, 0]), size: vector([kBox.size, kBox.size, kBox.size]), color: colour(0.2, 0.55, 0.3) }] }] });
  let nearest = { distance: Infinity }, trail = [];
  for (let k = 0; k <= duration * 60; ++k) {
    const t = k / 60, now = links(final(t));
    const transforms = now.map((link, i) => ({ timestamp: stamp(t), parent_frame_id: "world", child_frame_id: `arm/link_${i}`, translation: vector(link.at), rotation: link.turn }));
    transforms.push({ timestamp: stamp(t), parent_frame_id: "world", child_frame_id: "obstacle/box", translation: vector(kBox.at), rotation: identity });
    await put("/tf", "foxglove.FrameTransforms", t, { transforms });
    const { update, proximities } = forces(now, t);
    await put("/scene/forces", "foxglove.SceneUpdate", t, update);
    for (const one of proximities) if (one.distance < nearest.distance) nearest = { ...one, t };
    await put("/distance/proximities", "oca.ProximitySet", t, { value: proximities });
    trail.push([vector(now.at(-1).at), vector(links(requested(t)).at(-1).at)]);
    if (trail.length === 10) {
      const piece = (name, which) => ({ timestamp: stamp(t), frame_id: "world", id: `arm/${name}/${k}`, lines: [{ type: 0, pose: pose([0, 0, 0]), points: trail.map((one) => one[which]), color: colour(0, 0, 0), colors: [], indices: [] }] });
      await put("/scene/trails", "foxglove.SceneUpdate", t, { deletions: [], entities: [piece("actual", 0), piece("requested", 1)] });
      trail = trail.slice(-1);
    }
  }
  for (let k = 0; k <= duration * 100; ++k) {
    const t = k / 100;
    await put("/spline/position", "oca.joints", t, named(requested(t)), jointSchema);
    await put("/limiter/limited_delta", "oca.joints", t, named(delta(t)), jointSchema);
    await put("/plant/position", "oca.joints", t, named(final(t)), jointSchema);
  }
  await put("/metrics", "oca.Metrics", duration, { name: "sample", duration, steps: 100 * duration, wall_seconds: 0.01,
    metrics: { min_distance: nearest.distance, min_distance_pair: [nearest.link, nearest.obstacle], min_distance_time: nearest.t, contact_time: 0, max_abs_delta: 0.3 },
    expectations: [{ name: "min_distance", value: nearest.distance, bound: ">= 0.02", at: duration, ok: nearest.distance >= 0.02 }] });
}
