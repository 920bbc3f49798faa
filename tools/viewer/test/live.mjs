// SPDX-License-Identifier: BSD-3-Clause
// The page and npm's client of foxglove.websocket.v1 on real runs.
import assert from "node:assert/strict";
import { execFile, spawn } from "node:child_process";
import { readFile, stat } from "node:fs/promises";
import { dirname, join } from "node:path";
import { fileURLToPath, pathToFileURL } from "node:url";
import { promisify } from "node:util";
import protocol from "@foxglove/ws-protocol";
import { WebSocket } from "ws";
import { openPage } from "./page.mjs";

export const kDiagram = join(dirname(fileURLToPath(import.meta.url)), "../../../diagrams/static_test.yaml");
const run = promisify(execFile);
const { FoxgloveClient } = protocol;

/** Starts a simulator that serves something; resolves to its address. */
export async function serve(simulator, args) {
  const child = spawn(simulator, args, { stdio: ["ignore", "pipe", "pipe"] });
  let text = "", errors = "";
  child.stderr.on("data", (data) => (errors += data));
  const url = await new Promise((resolve, reject) => {
    child.stdout.on("data", (data) => {
      text += data;
      const found = /http:\/\/[^\s]+/.exec(text);
      if (found) resolve(found[0]);
    });
    child.on("exit", (code) => reject(new Error(`ended with ${code}: ${text}${errors}`)));
  });
  const stop = () => new Promise((resolve) => {
    child.removeAllListeners("exit");
    child.on("exit", (code) => resolve({ code, text, errors }));
    child.kill("SIGINT");
  });
  return { url, stop, errors: () => errors };
}

export async function testView({ test, browser, simulator, folder, messagesOf, errorsOf, colours, show }) {
  const record = join(folder, "run.mcap"), report = join(folder, "run.html");
  await test("simulator run --record --report makes both", async () => {
    await run(simulator, ["run", kDiagram, "--record", record, "--report", report, "--no-progress"]);
    const { size } = await stat(report);
    console.log(`        report of 14.5 s: ${(size / 1e6).toFixed(1)} MB`);
    assert.ok(size < 15e6);
  });
  await test("a report of a real run shows arm, plots and summary", async () => {
    const { page, problems } = await openPage(browser, pathToFileURL(report).href);
    assert.deepEqual(errorsOf(problems), []);
    assert.ok(await colours(page) > 100);
    const titles = await page.locator("figcaption").allTextContents();
    for (const title of ["Requested joints", "Deltas", "Final joints", "Distances", "speeds"]) {
      assert.ok(titles.some((one) => one.includes(title)), `${title} in ${titles}`);
    }
    const bytes = await readFile(record);
    const messages = await messagesOf(bytes, "/plant/position");
    const data = await page.evaluate(() => window.oca.plots.data("Final joints"));
    assert.equal(data[0].length, messages.length);
    for (const row of [0, 500, messages.length - 1]) {
      Object.values(messages[row]).forEach((value, joint) => assert.equal(data[joint + 1][row], value));
    }
    assert.match(await page.textContent("#badges"), /✓ clear by 0\.2/);
    assert.match(await page.textContent(".pane.summary"), /min_distance/);
    assert.match(await page.textContent(".pane.summary"), /Not seen.*own links/);
    await show(page, 2);
    const before = await page.evaluate(() => window.oca.view.positionOf("arm/lwr4_link_7"));
    await show(page, 6);
    const after = await page.evaluate(() => window.oca.view.positionOf("arm/lwr4_link_7"));
    assert.ok(Math.hypot(...before.map((value, k) => value - after[k])) > 0.1);
    await page.context().close();
  });
  await test("simulator view serves the page on a record", async () => {
    const { url, stop } = await serve(simulator, ["view", record, "--port", "0"]);
    const { page, problems } = await openPage(browser, url);
    assert.deepEqual(errorsOf(problems), []);
    assert.ok(await page.evaluate(() => window.oca.player.end) > 14);
    await page.context().close();
    assert.equal((await stop()).code, 130);
  });
  await test("simulator view refuses what is no record", async () => {
    await assert.rejects(run(simulator, ["view", kDiagram]), (error) => error.code === 2 && /expected a record/.test(error.stderr));
  });
}

export function connect(url) {
  const client = new FoxgloveClient({ ws: new WebSocket(url.replace("http", "ws"), [FoxgloveClient.SUPPORTED_SUBPROTOCOL]) });
  const next = (event, wanted = () => true) => new Promise((resolve, reject) => {
    const timer = setTimeout(() => reject(new Error(`no ${event} within 30 s`)), 30000);
    const take = (value) => {
      if (!wanted(value)) return;
      clearTimeout(timer);
      client.off(event, take);
      resolve(value);
    };
    client.on(event, take);
  });
  return { client, next };
}

export async function testLive({ test, browser, simulator, errorsOf }) {
  const { url, stop } = await serve(simulator, ["run", kDiagram, "--live=0", "--log-level", "off"]);
  await test("npm's Foxglove client follows a run and changes it", async () => {
    const { client, next } = connect(url);
    const [channels] = await Promise.all([next("advertise", (list) => list.length > 0), next("serverInfo")]);
    const topics = new Map(channels.map((channel) => [channel.topic, channel]));
    for (const topic of ["/tf", "/scene/robots", "/scene/obstacles", "/scene/forces", "/plant/position"]) assert.ok(topics.has(topic), topic);
    const subscription = client.subscribe(topics.get("/tf").id);
    const boxAt = async (wanted) => next("message", ({ subscriptionId, data }) => {
      if (subscriptionId !== subscription) return false;
      const { transforms } = JSON.parse(new TextDecoder().decode(data));
      return wanted(transforms.find((one) => one.child_frame_id === "obstacle/box").translation);
    });
    await boxAt(({ z }) => Math.abs(z - 1) < 1e-9);
    client.setParameters([{ name: "obstacles.box.position", value: [0.1, 0.7, 1.3] }], "set");
    const answer = await next("parameterValues");
    assert.deepEqual(answer.parameters.find(({ name }) => name === "obstacles.box.position").value, [0.1, 0.7, 1.3]);
    await boxAt(({ x, z }) => Math.abs(x - 0.1) < 1e-9 && Math.abs(z - 1.3) < 1e-9);
    client.subscribeParameterUpdates([]);
    client.setParameters([{ name: "max_distance", value: -1 }]);  // the diagram refuses it
    await next("parameterValues", ({ parameters }) => parameters.some(({ name, value }) => name === "max_distance" && value === 0.3));
    client.close();
  });
  await test("the page follows a run, and its sliders reach it", async () => {
    const { page, problems } = await openPage(browser, url);
    const before = await page.evaluate(() => window.oca.recording.end);
    await page.waitForFunction((time) => window.oca.recording.end > time + 0.5, before);
    await page.waitForFunction(() => window.oca.view.positionOf("arm/lwr4_link_7"));
    await page.evaluate(() => window.oca.selectNumber(3));
    const slider = page.locator(".knob", { hasText: "force_gain" }).locator("input[type=number]");
    const watcher = connect(url);
    const taken = watcher.next("serverInfo", ({ metadata }) => metadata["oca.parameters/force_gain"] === "2.5");
    await slider.fill("2.5");
    await slider.blur();
    await taken;
    const { client, next } = connect(url);
    await next("serverInfo");
    client.getParameters(["force_gain"], "g");
    assert.equal((await next("parameterValues", ({ id }) => id === "g")).parameters[0].value, 2.5);
    await page.waitForFunction(() => window.oca.recording.about("force_gain", "oca.parameters") === "2.5");
    client.close();
    watcher.client.close();
    assert.deepEqual(errorsOf(problems), []);
    await page.context().close();
  });
  await test("a run that was shown ends when it is told", async () => {
    const { code, text } = await stop();
    assert.equal(code, 130, text);
    assert.match(text, /[2-9]\d* changes|[2-9] changes/);
  });
}
