// SPDX-License-Identifier: BSD-3-Clause
// The page of a robot that no run moves: made-up ones whose answers are known, and real ones against the simulator.
import assert from "node:assert/strict";
import { execFile, execFileSync } from "node:child_process";
import { join } from "node:path";
import { pathToFileURL } from "node:url";
import { promisify } from "node:util";
import { serve } from "./live.mjs";
import { openPage } from "./page.mjs";
import { floaterRecord, kFloater, kHostile, turner, turnerPoses, turnerRecord } from "./sample_robot.mjs";

const run = promisify(execFile);

/** Poses of all links (m; quaternions x, y, z, w) and pairs of names in contact, of the page at positions. */
const at = (page, values) => page.evaluate((positions) => {
  const { oca } = window;
  oca.set(positions);
  return { poses: oca.poses.map(({ p, q }) => [...p.toArray(), ...q.toArray()]),
           shown: oca.robot.links.map(({ frame }) => oca.view.positionOf(frame)),
           contacts: oca.contacts.map((pair) => pair.map((link) => oca.robot.links[link].name)) };
}, values);

/** The same pose: quaternions of either sign turn alike. */
function assertSame(got, wanted, what) {
  const sign = Math.sign(got.slice(3).reduce((sum, value, k) => sum + value * wanted[3 + k], 0)) || 1;
  const off = Math.max(...got.map((value, k) => Math.abs(value - (k < 3 ? 1 : sign) * wanted[k])));
  assert.ok(off < 1e-9, `${what}: ${off} off, got ${got}, expected ${wanted}`);
}

/** Numbers from 0 to 1, the same every time. source Park, Miller 1988 */
function drawer(seed) {
  let state = seed;
  return () => (state = (state * 48271) % 2147483647) / 2147483647;
}

/** How far two boxes are apart along the best of the 15 axes that can separate them; negative: they overlap. */
function gap(a, b, turned) {
  const axes = [0, 1, 2].map((k) => [0, 1, 2].map((i) => (i === k ? 1 : 0)));
  const columns = [0, 1, 2].map((k) => turned.map((row) => row[k]));
  const cross = ([ax, ay, az], [bx, by, bz]) => [ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx];
  const dot = (u, v) => u[0] * v[0] + u[1] * v[1] + u[2] * v[2];
  const all = [...axes, ...columns, ...axes.flatMap((u) => columns.map((v) => cross(u, v)))];
  return Math.max(...all.filter((axis) => Math.hypot(...axis) > 1e-6).map((axis) => {
    const n = axis.map((value) => value / Math.hypot(...axis));
    const reach = (size, of) => size.reduce((sum, edge, k) => sum + (edge / 2) * Math.abs(dot(of[k], n)), 0);
    return Math.abs(dot(b.at, n)) - reach(a.size, axes) - reach(b.size, columns);
  }));
}

/** Rx Ry Rz of angles. */
function turn([x, y, z]) {
  const about = (k, angle) => [0, 1, 2].map((i) => [0, 1, 2].map((j) => {
    if (i === k || j === k) return i === j ? 1 : 0;
    return i === j ? Math.cos(angle) : (j === (i + 1) % 3 ? -1 : 1) * Math.sin(angle);
  }));
  const times = (a, b) => a.map((row) => [0, 1, 2].map((j) => row[0] * b[0][j] + row[1] * b[1][j] + row[2] * b[2][j]));
  return times(times(about(0, x), about(1, y)), about(2, z));
}

async function testJoints({ test, browser, errorsOf }, file) {
  await test("the links of a robot are where its joints put them", async () => {
    const { page, problems } = await openPage(browser, file);
    for (const values of [[0, 0], [0.7, 0.25], [-1.9, 0.4], [2, -0.1]]) {
      const { poses, shown } = await at(page, values);
      turnerPoses(values).forEach((wanted, link) => {
        assertSame(poses[link], wanted, turner.links[link].name);
        shown[link].forEach((value, k) => assert.ok(Math.abs(value - wanted[k]) < 1e-9));
      });
    }
    assert.deepEqual(errorsOf(problems), []);
    await page.context().close();
  });
  await test("a slider moves its joint and what mimics it, and says where they are", async () => {
    const { page } = await openPage(browser, file);
    const rows = page.locator(".joint");
    assert.equal(await rows.count(), 3);  // the fixed one has none
    assert.match(await rows.nth(0).textContent(), /rad-2 … 2/);
    assert.match(await rows.nth(1).textContent(), /slidem-0\.1 … 0\.4/);
    assert.match(await rows.nth(2).textContent(), /backradfollows -1 · .*\+ 0\.5/);
    await rows.nth(0).locator("input[type=range]").fill("1.25");
    assert.deepEqual(await page.evaluate(() => window.oca.values), [1.25, 0]);
    assert.equal(await rows.nth(0).locator("input[type=number]").inputValue(), "1.25");
    assert.equal(await rows.nth(2).locator("input[type=number]").inputValue(), "-0.75");
    assert.ok(await rows.nth(2).locator("input[type=range]").isDisabled());
    await rows.nth(1).locator("input[type=number]").fill("0.45");
    await rows.nth(1).locator("input[type=number]").press("Enter");
    assert.deepEqual(await page.evaluate(() => window.oca.values), [1.25, 0.45]);
    assert.match(await rows.nth(1).getAttribute("class"), /beyond/);
    await page.locator("h1").click();
    await page.keyboard.press("0");
    assert.deepEqual(await page.evaluate(() => window.oca.values), [0, 0]);
    await page.context().close();
  });
}

async function testOwnContacts({ test, browser, write, embed, page_text }, file) {
  await test("own links that touch are told, and pairs that nobody checks are not", async () => {
    const { page } = await openPage(browser, file);
    // The ball of 0.1 m meets the box of 0.1 m, 0.2 m away, once that has come 0.05 m nearer; the ball of 0.06 m above never does.
    assert.deepEqual((await at(page, [0.3, -0.0499])).contacts, []);
    assert.match(await page.textContent(".contacts"), /None of the 3 pairs .* no SRDF/);
    assert.deepEqual((await at(page, [0.3, -0.0501])).contacts, [[kHostile[2], kHostile[3]]]);
    assert.match(await page.textContent(".contacts"), /1 of the 3 pairs/);
    assert.match(await page.textContent("#badges"), /✗ 1 own pair in contact/);
    await page.context().close();
  });
  await test("a mesh and a box touch when no axis separates them", async () => {
    const { page } = await openPage(browser, await write("floater.html", embed(page_text, await floaterRecord())));
    assert.match(await page.textContent(".contacts"), /the one pair .* disables 3/);
    const draw = drawer(7), counts = { apart: 0, together: 0 };
    for (let k = 0; k < 300; ++k) {
      const place = [0, 0, 0].map(() => 0.7 * (draw() - 0.5)), angles = [0, 0, 0].map(() => 6 * (draw() - 0.5));
      const apart = gap({ size: kFloater.still }, { size: kFloater.moving, at: place }, turn(angles));
      if (Math.abs(apart) < 1e-6) continue;
      const { contacts } = await at(page, [...place, ...angles]);
      assert.equal(contacts.length, apart < 0 ? 1 : 0, `${apart} m at ${place}, ${angles}`);
      ++counts[apart < 0 ? "together" : "apart"];
    }
    assert.ok(counts.apart > 50 && counts.together > 50, JSON.stringify(counts));
    await page.context().close();
  });
}

async function testMarks({ test, browser }, file) {
  await test("warnings stand at their links, and what is pointed at shows", async () => {
    const { page } = await openPage(browser, file);
    const warnings = page.locator("#warnings .warning");
    assert.equal(await warnings.count(), 2);
    assert.equal(await page.locator(".label.warned").count(), 1);
    await page.evaluate(() => window.oca.selectNumber(1));
    const rows = page.locator(".pane.links tbody tr");
    assert.equal(await rows.locator(".mark").count(), 1);
    const on = () => rows.evaluateAll((all) => all.map((row) => row.classList.contains("on")));
    await warnings.first().hover();
    assert.deepEqual(await on(), [false, true, false, false, false]);
    await warnings.first().click();
    await page.locator("h1").hover();
    assert.deepEqual(await on(), [false, true, false, false, false]);
    await warnings.first().click();
    await page.locator("h1").hover();
    assert.deepEqual(await on(), [false, false, false, false, false]);
    await rows.nth(4).hover();
    const painted = await page.evaluate(() => window.oca.view.coloursOf(window.oca.robot.links[4].frame));
    assert.deepEqual(painted, [await page.evaluate(() => window.oca.page.colour("--accent")), await page.evaluate(() => window.oca.page.colour("--accent"))]);
    await page.context().close();
  });
  await test("a link under the pointer shows, and a click holds on to it", async () => {
    const { page } = await openPage(browser, file);
    const box = await page.locator("#view").boundingBox();
    const [x, y] = await page.evaluate(() => {
      const { x, y } = window.oca.poses[1].p.clone().project(window.oca.view.camera);
      return [(1 + x) / 2, (1 - y) / 2];
    });
    const shown = () => page.locator(".pane.links tbody tr.on th").allTextContents();
    await page.mouse.move(box.x + x * box.width, box.y + y * box.height);
    assert.deepEqual(await shown(), [`${kHostile[2]} ⚠`]);
    await page.mouse.down();
    await page.mouse.up();
    await page.mouse.move(box.x + 3, box.y + box.height - 3);
    assert.deepEqual(await shown(), [`${kHostile[2]} ⚠`]);
    await page.mouse.move(box.x + x * box.width, box.y + y * box.height);
    await page.mouse.down();
    await page.mouse.move(box.x + x * box.width + 40, box.y + y * box.height);  // turns the view
    await page.mouse.up();
    await page.mouse.move(box.x + 3, box.y + box.height - 3);
    assert.deepEqual(await shown(), [`${kHostile[2]} ⚠`]);
    await page.context().close();
  });
}

async function testLooks({ test, browser, errorsOf, colours }, file) {
  await test("collision shapes and visuals are shown and hidden apart", async () => {
    const { page } = await openPage(browser, file);
    const seen = () => page.evaluate(() => Object.fromEntries(["/scene/robots", "/scene/collisions"].map((topic) => [topic, window.oca.view.isOn(topic)])));
    assert.ok(await colours(page) > 100);
    await page.locator("[data-layer=collisions]").click();
    assert.deepEqual(await seen(), { "/scene/robots": true, "/scene/collisions": false });
    await page.keyboard.press("1");
    assert.deepEqual(await seen(), { "/scene/robots": false, "/scene/collisions": false });
    await page.keyboard.press("2");
    assert.deepEqual(await seen(), { "/scene/robots": false, "/scene/collisions": true });
    assert.equal(await page.getAttribute("[data-layer=visuals]", "aria-pressed"), "false");
    await page.context().close();
  });
  await test("names of a robot stay text, whatever they are", async () => {
    const { page, problems } = await openPage(browser, file);
    assert.equal(await page.textContent("h1"), kHostile[0]);
    for (const name of kHostile.slice(1)) {
      assert.ok((await page.locator(".pane.links tbody th").allTextContents()).some((text) => text.startsWith(name)), name);
    }
    assert.equal(await page.locator("img, main b, main i:not(.bar i)").count(), 0);
    assert.deepEqual(errorsOf(problems), []);
    await page.context().close();
  });
  await test("a robot fits on a desk and on a phone, dark and light", async () => {
    for (const viewport of [{ width: 1440, height: 860 }, { width: 390, height: 844 }]) {
      for (const theme of ["light", "dark"]) {
        const { page } = await openPage(browser, `${file}?theme=${theme}`, { viewport });
        const [wide, high] = await page.evaluate(() => [document.documentElement.scrollWidth, document.documentElement.scrollHeight]);
        assert.ok(wide <= viewport.width && high <= viewport.height, `${wide} x ${high} of ${viewport.width} x ${viewport.height}`);
        assert.ok(await colours(page) > 50);
        await page.context().close();
      }
    }
  });
}

export async function testRobot(tools) {
  const { write, embed, page_text } = tools;
  const file = await write("turner.html", embed(page_text, await turnerRecord()));
  await testJoints(tools, file);
  await testOwnContacts(tools, file);
  await testMarks(tools, file);
  await testLooks(tools, file);
}

/** A chain of every kind of shape (a capsule is a cylinder with two spheres), short enough that its links meet. */
function zoo() {
  const solid = (shape, z = 0) => `<collision><origin xyz="0.02 0 ${z}" rpy="0.3 0.2 0.1"/><geometry>${shape}</geometry></collision>`;
  const capsule = ["<cylinder radius='0.04' length='0.1'/>", "<sphere radius='0.04'/>", "<sphere radius='0.04'/>"]
    .map((shape, k) => `<collision><origin xyz="0 0 ${[0.05, 0, 0.1][k]}"/><geometry>${shape}</geometry></collision>`).join("");
  const shapes = [solid("<box size='0.1 0.12 0.14'/>"), solid("<cylinder radius='0.05' length='0.12'/>"), capsule, solid("<sphere radius='0.06'/>"),
                  solid("<mesh filename='package://lwr4/meshes/wrist.stl' scale='0.5 0.5 0.5'/>"), solid("<box size='0.05 0.2 0.05'/>", 0.05), solid("<cylinder radius='0.03' length='0.2'/>")];
  const links = shapes.map((shape, k) => `<link name="l${k}">${shape}</link>`).join("");
  const joint = (k, type, more) => `<joint name="j${k}" type="${type}"><parent link="l${k - 1}"/><child link="l${k}"/>
    <origin xyz="0.05 0.02 0.12" rpy="0.4 ${0.3 * k} 0.7"/>${more}<limit lower="-2" upper="2" effort="1" velocity="1"/></joint>`;
  const joints = [joint(1, "revolute", "<axis xyz='1 1 0'/>"), joint(2, "prismatic", "<axis xyz='0 0.3 1'/>").replace(/-2|"2"/g, (x) => (x === "-2" ? "-0.3" : '"0.1"')),
                  joint(3, "continuous", "<axis xyz='0 0 -1'/>"), joint(4, "revolute", "<axis xyz='0 1 0.2'/><mimic joint='j1' multiplier='-0.7' offset='0.2'/>"),
                  joint(5, "fixed", ""), joint(6, "revolute", "<axis xyz='-1 0 0.5'/>")].join("");
  return `<robot name="zoo">${links}${joints}</robot>`;
}

/** What the simulator says of a robot at positions: poses as above, pairs that touch and those that just do not, nearer than 1e-5 m. */
function truth(simulator, urdf, all) {
  const ask = (type, params, lines) => execFileSync(simulator, ["eval", type, "--model", `arm=${urdf}`, "--params", JSON.stringify({ model: "arm", ...params })],
    { input: lines.map((line) => `${JSON.stringify(line)}\n`).join(""), maxBuffer: 1 << 28, stdio: ["pipe", "pipe", "ignore"] })
    .toString().trim().split("\n").map((line) => JSON.parse(line));
  const links = ask("RobotKinematics", {}, all.map((position) => ({ position })));
  const near = ask("BulletDistance", { max_distance: 0.01, self_collision: true }, links.map((one) => ({ links: one.links, obstacles: [] })));
  return links.map((one, k) => {
    const pairs = (wanted) => new Set(near[k].proximities.filter(({ distance }) => wanted(distance))
      .map(({ link, obstacle }) => [link, obstacle.replace(/^arm\//, "")].sort().join(" – ")));
    return { poses: one.links.map(({ pose }) => [...pose.xyz, ...pose.quaternion]), touching: pairs((d) => d < -1e-5), unsure: pairs((d) => Math.abs(d) <= 1e-5) };
  });
}

export async function testRealRobots({ test, browser, simulator, folder, write, errorsOf, colours }) {
  const made = decodeURIComponent(new URL(await write("zoo.urdf", zoo())).pathname);
  let met = 0;
  for (const urdf of ["package://lwr4/lwr4.urdf", "package://ur5e/ur5e.urdf", made]) {
    await test(`the page has ${urdf.replace(/.*\//, "")} where the simulator has it, and the same links touch`, async () => {
      const html = join(folder, "robot.html");
      await run(simulator, ["robot", "show", urdf, "-o", html]);
      const { page, problems } = await openPage(browser, pathToFileURL(html).href);
      const ranges = await page.evaluate(() => window.oca.robot.positions.map(({ range }) => range));
      const draw = drawer(11), all = Array.from({ length: 100 }, () => ranges.map(([low, high]) => low + draw() * (high - low)));
      const wanted = truth(simulator, urdf, all);
      for (const [k, values] of all.entries()) {
        const { poses, contacts } = await at(page, values);
        assert.equal(poses.length, wanted[k].poses.length);
        poses.forEach((pose, link) => assertSame(pose, wanted[k].poses[link], `link ${link} at ${values}`));
        const touching = new Set(contacts.map((pair) => [...pair].sort().join(" – ")).filter((pair) => !wanted[k].unsure.has(pair)));
        assert.deepEqual([...touching].sort(), [...wanted[k].touching].sort(), `at ${values}`);
        met += touching.size;
      }
      assert.ok(await colours(page) > 100);
      assert.deepEqual(errorsOf(problems), []);
      await page.context().close();
    });
  }
  await test("some of these links touch", () => assert.ok(met > 100, `${met}`));
  await test("simulator robot show serves the page, with what an SRDF disables", async () => {
    const { url, stop } = await serve(simulator, ["robot", "show", "package://ur5e/ur5e.urdf", "--srdf", "package://ur5e/ur5e.srdf", "--port", "0"]);
    const { page, problems } = await openPage(browser, url);
    assert.match(await page.textContent(".contacts"), /the SRDF disables \d+/);
    assert.deepEqual(errorsOf(problems), []);
    await page.context().close();
    assert.equal((await stop()).code, 130);
  });
}
