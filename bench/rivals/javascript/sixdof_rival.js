"use strict";
/**
 * The server loop of an algorithm for Node: serve(Query, description) answers the protocol of lib/sixdof/process/README.md.
 *
 *     class Query {
 *       constructor(a, b, settings) {}  // two meshes {name, vertices, triangles}; throw new BadMesh(words), BadArgument
 *       collide(pose) {}                // true or false
 *       distance(pose) {}               // {distance}, or {distance, a, b} with the closest points
 *       respond(pose) {}                // {penalty, force, torque, reference} and, optional, volume
 *       cast(motion) {}                 // null, or {t} and, optional, a, b, normal
 *       contacts(pose, most) {}         // {points, normals, depths}, at most `most` of each; normals from A to B
 *       footprint() {}                  // optional: {bytes, counts}
 *       release() {}                    // optional: gives back what no garbage collector sees, before the next pair
 *     }
 *
 * It needs the methods that it answers only. `vertices` is a Float64Array, `triangles` a Uint32Array, three numbers a row;
 * B is A itself where it is a copy. The pose is an array of the twelve numbers; a motion is
 * {pose, translation, rotation, reference}, three numbers each but for the start; points and forces are in A's frame. throw
 * new Failed(words) where the library gives up; any other exception counts as failed, too. A method is timed from the
 * twelve numbers of the pose to its return.
 */

const fs = require("node:fs");

const KINDS = ["collide", "distance", "respond", "cast"]; // that are asked by a place alone; contacts have a number besides
const MOST_WORDS = 400;

class BadMesh extends Error {}
class BadArgument extends Error {}
class Failed extends Error {
  /** @param status one of query/README.md */
  constructor(words, status = "failed") {
    super(words);
    this.status = status;
  }
}

/** Answers requests until the input ends. `description` has the keys of the reply to hello. */
function serve(Query, description) {
  // What a library prints goes to standard error.
  process.stdout.write = process.stderr.write.bind(process.stderr);
  const server = new Server(Query, description);
  for (const line of lines(0)) write(1, JSON.stringify(server.reply(line)) + "\n");
}

function* lines(descriptor) {
  const block = Buffer.alloc(1 << 16);
  let parts = [];
  while (true) {
    const count = retried(() => fs.readSync(descriptor, block, 0, block.length, null));
    if (count === 0) return;
    let text = Buffer.from(block.subarray(0, count));
    for (let end = text.indexOf(10); end >= 0; end = text.indexOf(10)) {
      yield Buffer.concat([...parts, text.subarray(0, end)]).toString();
      parts = [];
      text = text.subarray(end + 1);
    }
    parts.push(text);
  }
}

function write(descriptor, text) {
  let rest = Buffer.from(text);
  while (rest.length > 0) rest = rest.subarray(retried(() => fs.writeSync(descriptor, rest)));
}

/** A pipe that is not ready throws EAGAIN, one that has ended EOF. */
function retried(call) {
  while (true) {
    try {
      return call();
    } catch (e) {
      if (e.code === "EOF") return 0;
      if (e.code !== "EAGAIN") throw e;
      Atomics.wait(new Int32Array(new SharedArrayBuffer(4)), 0, 0, 1); // ms
    }
  }
}

class Server {
  constructor(Query, description) {
    this.Query = Query;
    // Not "progress": Node cannot map a file, and a write would be a call of the system in each query.
    this.hello = { protocol: 1, parameters: [], ...description, can: ["time", "again"] };
    this.query = null;
  }

  reply(line) {
    try {
      const request = JSON.parse(line);
      if (request.do === "hello") return this.greet(request);
      if (request.do === "prepare") return this.prepare(request);
      if (request.do === "ask") return this.ask(request);
      if (request.do === "time") return this.time(request);
      throw new Error(`"${request.do}" is not known`);
    } catch (e) {
      const kind = e instanceof BadMesh ? "bad_mesh" : e instanceof BadArgument ? "bad_argument" : "error";
      return { error: words(e), kind };
    }
  }

  greet(request) {
    if (request.protocol !== 1) throw new Error(`not version ${request.protocol} of the protocol`);
    return this.hello;
  }

  prepare(request) {
    if (this.query?.release) this.query.release();
    this.query = null;
    const a = readMesh(request.a);
    const same = request.a.vertices === request.b.vertices && request.a.triangles === request.b.triangles;
    const b = same ? a : readMesh(request.b);
    const defaults = Object.fromEntries(this.hello.parameters.map((each) => [each.name, each.default]));
    const cpu = processorTime(), wall = now();
    this.query = new this.Query(a, b, { ...defaults, ...request.settings });
    const reply = { prepared: true, ns: now() - wall, cpu_ns: processorTime() - cpu };
    return { ...reply, ...(this.query.footprint ? this.query.footprint() : {}) };
  }

  /** Throws BadArgument. @returns null for a kind that the algorithm does not answer */
  kind(request) {
    if (this.query === null) throw new BadArgument("nothing is prepared");
    if (!KINDS.includes(request.query)) throw new BadArgument(`"${request.query}" is no kind of query`);
    return this.hello.answers.includes(request.query) ? request.query : null;
  }

  ask(request) {
    if (request.query === "contacts") return this.askContacts(readPose(request.pose), request.most);
    const kind = this.kind(request);
    const place = request.query === "cast" ? readMotion(request) : readPose(request.pose);
    const [ns, reply] = timed(this.query, kind, place);
    return { ...reply, ns };
  }

  askContacts(pose, most) {
    if (this.query === null) throw new BadArgument("nothing is prepared");
    const kind = this.hello.answers.includes("contacts") ? "contacts" : null;
    const [ns, reply] = timed({ contacts: (at) => this.query.contacts(at, most) }, kind, pose);
    return { ...reply, ns };
  }

  time(request) {
    const kind = this.kind(request), poses = request.poses.map(readPose);
    return request.each ? this.timeEach(request, kind, poses) : this.timePasses(request, kind, poses);
  }

  timeEach(request, kind, poses) {
    const buffer = new Float64Array(request.evict_bytes / 8).fill(1);
    const once = [], least = Array(poses.length).fill(Infinity), failed = new Map();
    for (let pass = 0; pass < request.passes; ++pass) {
      poses.forEach((pose, i) => {
        evict(buffer);
        const [ns, reply] = timed(this.query, kind, pose);
        if (pass === 0) once.push(ns);
        least[i] = Math.min(least[i], ns);
        if (reply.status && !failed.has(i)) failed.set(i, [i, reply.status, reply.words]);
      });
    }
    return { once_ns: once, least_ns: least, failed: [...failed.values()] };
  }

  timePasses(request, kind, poses) {
    const cpu = processorTime(), wall = now();
    for (let pass = 0; pass < request.passes; ++pass) {
      for (const pose of poses) {
        try {
          sink = this.query[kind](pose);
        } catch {
          // timeEach() says which
        }
      }
    }
    return { wall_ns: now() - wall, cpu_ns: processorTime() - cpu };
  }
}

/** Keeps the compiler from leaving out what is computed. */
let sink = 0;

/** Reads one number of each cache line. */
function evict(buffer) {
  let sum = 0;
  for (let i = 0; i < buffer.length; i += 8) sum += buffer[i];
  sink = sum;
}

/** ns of a monotonic clock */
function now() {
  return 1e6 * performance.now();
}

/** ns of all threads */
function processorTime() {
  const { user, system } = process.cpuUsage();
  return 1e3 * (user + system);
}

/** Wall time of a query in ns, and its reply. `pose` is a motion for a cast. */
function timed(query, kind, pose) {
  if (kind === null) return [0, { status: "unsupported", words: "not a question for this algorithm" }];
  const numbers = kind === "cast" ? Object.values(pose).flat() : pose;
  if (!numbers.every(Number.isFinite)) {
    return [0, { status: "non_finite", words: `the ${kind === "cast" ? "motion" : "pose"} is not finite` }];
  }
  const start = now();
  let answer, failure = null;
  try {
    answer = query[kind](pose);
  } catch (e) {
    failure = e;
  }
  const ns = now() - start;
  return [ns, failure === null ? replyOf(kind, answer) : { status: failure.status ?? "failed", words: words(failure) }];
}

function replyOf(kind, answer) {
  if (kind === "collide") return { collide: Boolean(answer) };
  if (kind === "cast" && answer === null) return { hit: false };
  // JSON has no numbers that are not finite.
  if (Object.values(answer).flat(2).every(Number.isFinite)) return kind === "cast" ? { hit: true, ...answer } : answer;
  return { status: "non_finite", words: "the answer is not finite" };
}

function words(error) {
  return String(error?.message ?? error).slice(0, MOST_WORDS) || "no message";
}

function readMesh(place) {
  const rows = (path, count, size) => {
    const bytes = fs.readFileSync(path), length = 3 * count * size;
    if (bytes.length < length) throw new Error(`${path}: fewer than ${count} rows`);
    return bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + length);
  };
  return {
    name: place.name,
    vertices: new Float64Array(rows(place.vertices, place.vertex_count, 8)),
    triangles: new Uint32Array(rows(place.triangles, place.triangle_count, 4)),
  };
}

function readPose(numbers) {
  if (numbers.length !== 12) throw new Error("a pose does not have twelve numbers");
  return readNumbers(numbers);
}

function readNumbers(numbers) {
  const special = { nan: NaN, inf: Infinity, "-inf": -Infinity };
  return numbers.map((x) => (typeof x === "string" ? special[x] : x));
}

function readMotion(request) {
  const { translation, rotation, reference } = request;
  for (const vector of [translation, rotation, reference]) {
    if (vector?.length !== 3) throw new Error("a motion does not have three vectors of three numbers");
  }
  const [moved, turned, point] = [translation, rotation, reference].map(readNumbers);
  return { pose: readPose(request.pose), translation: moved, rotation: turned, reference: point };
}

/** Longest edge of the box around a mesh. */
function extent(mesh) {
  const low = [Infinity, Infinity, Infinity], high = [-Infinity, -Infinity, -Infinity];
  mesh.vertices.forEach((x, i) => {
    low[i % 3] = Math.min(low[i % 3], x);
    high[i % 3] = Math.max(high[i % 3], x);
  });
  return Math.max(...high.map((x, i) => x - low[i]));
}

/** A parameter with a few values, for the description. */
function choice(name, meaning, initial, choices) {
  return { name, meaning, unit: "1", default: initial, choices };
}

/** Of a package in NODE_PATH. */
function version(name) {
  return JSON.parse(fs.readFileSync(`${process.env.NODE_PATH}/${name}/package.json`)).version;
}

module.exports = { serve, version, choice, extent, BadMesh, BadArgument, Failed };
