// SPDX-License-Identifier: BSD-3-Clause
// node test/run.mjs [SIMULATOR]: the page in a real browser, on a made-up record and, if a simulator
// is named, on its report, its view and its live run.
import assert from "node:assert/strict";
import { mkdtemp, readFile, rm, writeFile } from "node:fs/promises";
import { tmpdir } from "node:os";
import { dirname, join } from "node:path";
import { fileURLToPath, pathToFileURL } from "node:url";
import { decompress } from "fzstd";
import { McapIndexedReader } from "@mcap/core";
import { embed, kNoWebGL, launch, openPage } from "./page.mjs";
import { delta, final, requested, sampleRecord } from "./sample_record.mjs";
import { testLive, testView } from "./live.mjs";
import { testRealRobots, testRobot } from "./robot.mjs";
import { testAccess, testTruth } from "./truth.mjs";

const here = dirname(fileURLToPath(import.meta.url));
const simulator = process.argv[2];
const viewer = process.env.OCA_VIEWER ?? join(here, "../dist/viewer.html");
const folder = await mkdtemp(join(tmpdir(), "oca_viewer_"));
const browser = await launch();
const kTip = "arm/link_6";
let failures = 0;

async function test(name, body) {
  try {
    await body();
    console.log(`ok      ${name}`);
  } catch (error) {
    ++failures;
    console.log(`FAILED  ${name}\n${error.stack ?? error}`);
  }
}

async function write(name, bytes) {
  const path = join(folder, name);
  await writeFile(path, bytes);
  return pathToFileURL(path).href;
}

const errorsOf = (problems) => problems.filter((problem) => problem.startsWith("error"));
const show = (page, time) => page.evaluate((at) => new Promise((done) => {
  window.oca.player.seek(at);
  requestAnimationFrame(() => requestAnimationFrame(() => done(window.oca.player.time)));
}), time);
/** How many colours the scene has: one or two mean that nothing is drawn. */
const colours = (page) => page.evaluate(() => {
  const source = document.querySelector("#view canvas"), copy = document.createElement("canvas");
  [copy.width, copy.height] = [200, 120];
  const context = copy.getContext("2d");
  context.drawImage(source, 0, 0, copy.width, copy.height);
  const { data } = context.getImageData(0, 0, copy.width, copy.height);
  const seen = new Set();
  for (let i = 0; i < data.length; i += 4) seen.add((data[i] << 16) | (data[i + 1] << 8) | data[i + 2]);
  return seen.size;
});

/** The messages of a topic, by an own reading of the record. */
async function messagesOf(bytes, topic) {
  const reader = await McapIndexedReader.Initialize({
    readable: { size: async () => BigInt(bytes.length), read: async (offset, length) => bytes.subarray(Number(offset), Number(offset + length)) },
    decompressHandlers: { zstd: (data, size) => decompress(data, new Uint8Array(Number(size))) },
  });
  const found = [];
  for await (const message of reader.readMessages({ topics: [topic] })) found.push(JSON.parse(new TextDecoder().decode(message.data)));
  return found;
}

const page_text = await readFile(viewer, "utf8");
const record = await sampleRecord(10);
const sample = await write("sample.html", embed(page_text, record));

await test("a report opens offline without a word on the console", async () => {
  const long = embed(page_text, await sampleRecord(60));
  const requests = [];
  const { page, problems, milliseconds } = await openPage(browser, await write("long.html", long));
  page.on("request", (request) => requests.push(request.url()));
  assert.deepEqual(errorsOf(problems), []);
  const loaded = await page.evaluate(() => window.ocaLoadMilliseconds);
  console.log(`        60 s: ready after ${loaded.toFixed(0)} ms, drawn after ${milliseconds} ms, uncompressed ${(long.length / 1e6).toFixed(1)} MB`);
  assert.deepEqual(requests.filter((url) => url.startsWith("http")), []);
  await page.context().close();
});

await test("the scene shows more than a background", async () => {
  const { page } = await openPage(browser, sample);
  assert.ok(await colours(page) > 100, `${await colours(page)} colours`);
  await page.context().close();
});

await test("the time line moves the arm", async () => {
  const { page } = await openPage(browser, sample);
  const box = await page.locator("#timeline").boundingBox();
  await page.mouse.click(box.x + 0.1 * box.width, box.y + 10);
  const before = await page.evaluate((tip) => [window.oca.player.time, window.oca.view.positionOf(tip)], kTip);
  await page.mouse.click(box.x + 0.9 * box.width, box.y + 10);
  const after = await page.evaluate((tip) => [window.oca.player.time, window.oca.view.positionOf(tip)], kTip);
  assert.ok(Math.abs(before[0] - 1) < 0.05 && Math.abs(after[0] - 9) < 0.05, `${before[0]}, ${after[0]}`);
  const way = Math.hypot(...before[1].map((value, k) => value - after[1][k]));
  assert.ok(way > 0.1, `${way} m`);
  const [message] = (await messagesOf(record, "/tf")).slice(540);  // at 9 s
  const { translation } = message.transforms.find((one) => one.child_frame_id === kTip);
  await show(page, 9);
  const shown = await page.evaluate((tip) => window.oca.view.positionOf(tip), kTip);
  for (const [k, key] of ["x", "y", "z"].entries()) assert.ok(Math.abs(shown[k] - translation[key]) < 1e-6);
  await page.context().close();
});

await test("the plots have the values of the record", async () => {
  const { page } = await openPage(browser, sample);
  for (const [title, values] of [["Requested joints", requested], ["Deltas that avoidance adds", delta], ["Final joints", final]]) {
    const data = await page.evaluate((name) => window.oca.plots.data(name), title);
    assert.equal(data.length, 8, title);
    assert.equal(data[0].length, 1001, title);
    for (const row of [0, 333, 500, 1000]) {
      assert.ok(Math.abs(data[0][row] - row / 100) < 1e-9);
      values(row / 100).forEach((value, joint) => assert.equal(data[joint + 1][row], value));
    }
  }
  await page.context().close();
});

await test("distances of two arms count both, whatever their rates", async () => {
  const { page } = await openPage(browser, sample);
  const [least, column] = await page.evaluate(() => {
    const { recording } = window.oca, topics = ["/distance/proximities", "/other/proximities"];
    const other = recording.topic(topics[1]), near = [{ link: "other", obstacle: "box", distance: -0.05 }];
    for (let k = 0; k <= 20; ++k) recording.add(other, 1_700_000_000_000_000_000n + BigInt(k) * 500_000_000n, new TextEncoder().encode(JSON.stringify({ value: near })));
    recording.metadata.set("oca.plots", new Map([["plots", JSON.stringify([{ id: "distance", title: "Distances", topics }])]]));
    window.oca.load(recording);
    return [Math.min(...window.oca.timeline.nearness.values), window.oca.plots.data("Distances").slice(1).find((values) => values[0] === -0.05)];
  });
  assert.equal(least, -0.05);
  assert.equal(column?.length, 601);
  assert.ok(column.every((value) => value === -0.05));
  await page.context().close();
});

await test("while a run goes on, the nearest of all arms counts", async () => {
  const { page } = await openPage(browser, sample);
  await page.evaluate(() => {
    const { recording } = window.oca;
    recording.topics.delete("/metrics");
    const put = (arm, metrics) => recording.add(recording.topic(`/${arm}/metrics`), 1_700_000_000_000_000_000n, new TextEncoder().encode(JSON.stringify(metrics)));
    put("left", { min_distance: 0.4, min_distance_pair: ["left", "box"], min_distance_time: 1, max_joint_speed: 2 });
    put("right", { min_distance: -0.1, min_distance_pair: ["right", "box"], min_distance_time: 3, max_joint_speed: 1 });
    window.oca.load(recording);
  });
  assert.match(await page.textContent("#badges"), /✗ contact, 0\.100 m deep/);
  assert.match(await page.textContent(".pane.summary"), /-0\.100mNearestright – box, at 3\.00 s/);
  assert.match(await page.textContent(".pane.summary"), /2\.000rad\/sFastest joint/);
  await page.context().close();
});

await test("links that are always near each other do not mark the time line", async () => {
  const { page } = await openPage(browser, sample);
  const share = () => page.evaluate(() => {
    const { shares } = window.oca.timeline.nearness;
    return shares.filter((one) => one < 1).length / shares.length;
  });
  const before = await share();
  assert.ok(before > 0.05 && before < 0.8, `${before}`);
  await page.evaluate(() => {
    const { recording } = window.oca, topic = recording.topics.get("/distance/proximities");
    const other = recording.topic("/own/proximities"), near = (k) => [{ link: "one", obstacle: "arm/three", distance: 0.02 + 0.01 * Math.sin(k) }];
    topic.times.forEach((time, k) => recording.add(other, 1_700_000_000_000_000_000n + BigInt(Math.round(1e9 * time)), new TextEncoder().encode(JSON.stringify({ value: near(k) }))));
    recording.metadata.set("oca.plots", new Map([["plots", JSON.stringify([{ id: "distance", title: "Distances", topics: [topic.name, other.name] }])]]));
    window.oca.load(recording);
  });
  assert.equal(await share(), before);
  assert.ok(await page.evaluate(() => Math.min(...window.oca.timeline.nearness.values)) < 0.02);
  await page.context().close();
});

await test("a browser without WebGL says so, and shows all but the scene", async () => {
  const blind = await launch(kNoWebGL);
  const { page, problems } = await openPage(blind, sample);
  assert.deepEqual(errorsOf(problems), []);
  assert.equal(await page.locator("#message").isVisible(), false);
  assert.match(await page.textContent("#view"), /no WebGL/);
  assert.equal(await page.evaluate(() => window.oca.plots.data("Final joints")[0].length), 1001);
  await page.keyboard.press("Home");
  await page.keyboard.press(".");
  await page.keyboard.press("1");
  assert.match(await page.textContent("#clock"), /^0\.02 /);
  await page.keyboard.press("s");
  assert.ok(await page.locator(".card").count() > 2);
  await page.context().close();
  await blind.close();
});

await test("metrics of joints have the unit that the record says", async () => {
  const { page } = await openPage(browser, sample);
  const largest = (unit) => page.evaluate((name) => {
    window.oca.recording.metadata.get("oca").set("position_unit", name);
    window.oca.load(window.oca.recording);
    return [...document.querySelectorAll(".card")].map((card) => card.textContent).find((text) => text.endsWith("Largest delta"));
  }, unit);
  assert.equal(await largest("m"), "0.300mLargest delta");
  assert.equal(await largest("rad or m"), "0.300rad or mLargest delta");
  await page.context().close();
});

await test("an arm below a ceiling is looked at from below, any other from above", async () => {
  const { page } = await openPage(browser, sample);
  const height = () => page.evaluate(() => window.oca.view.camera.position.z - window.oca.view.controls.target.z);
  const plate = (z) => page.evaluate((at) => {
    const { recording } = window.oca, size = { x: 4, y: 4, z: 0.05 }, zero = { x: 0, y: 0, z: 0 }, turn = { x: 0, y: 0, z: 0, w: 1 };
    const entity = { timestamp: { sec: 1_700_000_000, nsec: 0 }, frame_id: "world", id: "arm/plate", frame_locked: true,
                     cubes: [{ pose: { position: { ...zero, z: at }, orientation: turn }, size, color: { r: 0.5, g: 0.5, b: 0.5, a: 1 } }] };
    recording.add(recording.topic("/scene/robots"), 1_700_000_000_000_000_000n, new TextEncoder().encode(JSON.stringify({ deletions: [], entities: [entity] })));
    window.oca.load(recording);
  }, z);
  assert.ok(await height() > 0.3);
  await plate(-0.05);
  assert.ok(await height() > 0.3);
  await plate(1.3);
  assert.ok(await height() < -0.1, `${await height()} m above what is looked at`);
  await page.context().close();
});

await test("a click in a plot moves the scene", async () => {
  const { page } = await openPage(browser, sample);
  const box = await page.locator(".u-over").first().boundingBox();
  await page.mouse.click(box.x + box.width / 2, box.y + 20);
  assert.ok(Math.abs(await page.evaluate(() => window.oca.player.time) - 5) < 0.1);
  await page.context().close();
});

await test("play moves time, keys step and switch", async () => {
  const { page } = await openPage(browser, sample);
  await page.keyboard.press("Home");
  await page.keyboard.press("Space");
  await page.waitForFunction(() => window.oca.player.time > 0.2);
  await page.keyboard.press("Space");
  assert.equal(await page.evaluate(() => window.oca.player.playing), false);
  await show(page, 2);
  await page.keyboard.press(".");
  assert.ok(Math.abs(await page.evaluate(() => window.oca.player.time) - (2 + 1 / 60)) < 1e-6);
  await page.keyboard.press("1");
  assert.equal(await page.getAttribute("[data-layer=distances]", "aria-pressed"), "false");
  await page.keyboard.press("l");
  assert.equal(await page.locator(".pane.limits").isVisible(), true);
  assert.ok(await page.locator(".strip").count() > 0);
  await page.context().close();
});

await test("dark and light, on a desk and on a phone, nothing runs over the edge", async () => {
  for (const viewport of [{ width: 1440, height: 860 }, { width: 390, height: 844 }]) {
    for (const theme of ["light", "dark"]) {
      const { page, problems } = await openPage(browser, `${sample}?theme=${theme}`, { viewport });
      const [wide, high] = await page.evaluate(() => [document.documentElement.scrollWidth, document.documentElement.scrollHeight]);
      assert.ok(wide <= viewport.width && high <= viewport.height, `${wide} x ${high} of ${viewport.width} x ${viewport.height}`);
      assert.ok(await colours(page) > 100);
      assert.deepEqual(errorsOf(problems), []);
      await page.context().close();
    }
  }
});

await test("a record that was cut is shown as far as it goes, and says so", async () => {
  const { page } = await openPage(browser, await write("cut.html", embed(page_text, record.subarray(0, record.length * 0.7))));
  assert.match(await page.textContent(".pane.summary"), /was cut/);
  assert.ok(await page.evaluate(() => window.oca.player.end) > 1);
  await page.context().close();
});

await test("names from a record stay text", async () => {
  const text = "<img src=x onerror=alert(1)>";
  const { page, problems } = await openPage(browser, sample);
  await page.evaluate((name) => {
    window.oca.recording.metadata.get("oca").set("description", name);
    window.oca.load(window.oca.recording);
  }, text);
  assert.equal(await page.textContent("#subtitle"), text);
  assert.equal(await page.locator("#subtitle img").count(), 0);
  assert.deepEqual(errorsOf(problems), []);
  await page.context().close();
});

await testRobot({ test, browser, write, embed, page_text, errorsOf, colours });

if (simulator) {
  await testRealRobots({ test, browser, simulator, folder, write, errorsOf, colours });
  await testView({ test, browser, simulator, folder, messagesOf, errorsOf, colours, show });
  await testLive({ test, browser, simulator, errorsOf });
  await testTruth({ test, browser, simulator, folder, viewer, errorsOf, show });
  await testAccess({ test, browser, simulator, folder, errorsOf });
}

await browser.close();
await rm(folder, { recursive: true });
console.log(failures === 0 ? "all passed" : `${failures} failed`);
process.exit(failures === 0 ? 0 : 1);
