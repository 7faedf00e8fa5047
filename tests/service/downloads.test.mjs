// What can be fetched of a report besides itself: everything as a ZIP, a summary, parts of pictures.
import assert from "node:assert/strict";
import { after, before, test } from "node:test";
import { assert_problem, lasting, QUICK, Service } from "./service.mjs";

const service = new Service();
let report;
before(async () => {
  await service.start();
  const spec = { ...QUICK, checks: [{ metric: "flip.mean", method: "f2b", max: 0.05 }] };
  report = await service.settled(await service.submit(spec));
});
after(() => service.end_well());

const bytes_of = async (response) => Buffer.from(await response.arrayBuffer());
const get = (path, headers = {}) => fetch(`${service.api}/reports/${report.id}/${path}`, { headers });

/** The names and bytes of the files of a ZIP that is not compressed, from its directory (APPNOTE.TXT 4.3.12). */
function files_of(zip) {
  const end = zip.length - 22;
  assert.equal(zip.readUInt32LE(end), 0x06054b50);
  const files = new Map();
  let at = zip.readUInt32LE(end + 16);
  for (let i = 0; i < zip.readUInt16LE(end + 10); ++i) {
    assert.equal(zip.readUInt32LE(at), 0x02014b50);
    const size = zip.readUInt32LE(at + 24);
    const name_bytes = zip.readUInt16LE(at + 28);
    const local = zip.readUInt32LE(at + 42);
    const begin = local + 30 + zip.readUInt16LE(local + 26);
    files.set(zip.toString("utf8", at + 46, at + 46 + name_bytes), zip.subarray(begin, begin + size));
    at += 46 + name_bytes;
  }
  return files;
}

test("the ZIP has the report, its pages and its pictures", async () => {
  const response = await get("report.zip");
  assert.equal(response.status, 200);
  assert.equal(response.headers.get("content-type"), "application/zip");
  const files = files_of(await bytes_of(response));
  const inside = JSON.parse(files.get("report.json"));
  assert.equal(inside.id, report.id);
  const pictures = inside.runs
    .flatMap((run) => [run.reference, ...run.results])
    .flatMap((one) => Object.values(one.images));
  assert.ok(pictures.length > 4);
  for (const { url, sha256 } of pictures)
    assert.deepEqual(files.get(url), await bytes_of(await fetch(`${service.api}/blobs/${sha256}`)), url);
  assert.deepEqual(files.get("junit.xml"), await bytes_of(await get("junit.xml")));
  assert.deepEqual(files.get("summary.md"), await bytes_of(await get("summary.md")));
  assert.match(files.get("report.html").toString(), /^<!doctype html>/i);
});

test("the summary begins with the verdict", async () => {
  const response = await get("summary.md");
  assert.equal(response.headers.get("content-type"), "text/markdown; charset=utf-8");
  assert.match(await response.text(), /^### Sheer: passed: One red layer\n/);
  const running = await service.submit(lasting(60));
  for (const path of ["summary.md", "report.zip"])
    await assert_problem(await fetch(`${service.api}/reports/${running}/${path}`), 409);
  await assert_problem(await fetch(`${service.api}/reports/nothing/report.zip`), 404);
  await fetch(`${service.api}/reports/${running}`, { method: "DELETE" });
});

test("a part of a picture can be fetched", async () => {
  const { sha256 } = report.runs[0].results[0].images.color;
  const url = `${service.api}/blobs/${sha256}`;
  const whole = await fetch(url);
  assert.equal(whole.headers.get("accept-ranges"), "bytes");
  const all = await bytes_of(whole);
  const part = async (range, more = {}) => fetch(url, { headers: { Range: range, ...more } });
  const middle = await part("bytes=3-9");
  assert.equal(middle.status, 206);
  assert.equal(middle.headers.get("content-range"), `bytes 3-9/${all.length}`);
  assert.deepEqual(await bytes_of(middle), all.subarray(3, 10));
  assert.deepEqual(await bytes_of(await part("bytes=-4")), all.subarray(all.length - 4));
  assert.deepEqual(await bytes_of(await part("bytes=5-", { "If-Range": `"${sha256}"` })), all.subarray(5));
  const other = await part("bytes=5-", { "If-Range": '"other"' });
  assert.equal(other.status, 200, "of another copy the whole is sent");
  const beyond = await part(`bytes=${all.length}-`);
  assert.equal(beyond.headers.get("content-range"), `bytes */${all.length}`);
  await assert_problem(beyond, 416);
  assert.equal((await part("bytes=0-1,3-4")).status, 200, "several ranges are not supported");
});
