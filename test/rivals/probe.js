"use strict";
// The same as probe.py. Its argument is the path of sixdof_rival.js.

const { serve, choice, BadMesh, BadArgument, Failed } = require(process.argv[2]);

const sum = (values) => values.reduce((total, x) => total + x, 0);

class Query {
  constructor(a, b, settings) {
    if (settings.mode === "bad_mesh") throw new BadMesh("a bad mesh");
    if (settings.mode === "bad_argument") throw new BadArgument("a bad argument");
    this.sum = sum(a.vertices) + sum(b.triangles);
    this.copies = a === b ? 1 : 0;
  }

  collide(pose) {
    return pose[9] < 0;
  }

  distance(pose) {
    const command = pose[10];
    if (command === 1) throw new Failed("gave up");
    if (command === 2) return { distance: NaN };
    if (command === 3) console.log("a library prints");
    if (command === 4) throw new RangeError("a library throws");
    return { distance: pose[9] + this.sum, a: [pose[9], 0, 0], b: [0, 0, this.copies] };
  }

  cast(motion) {
    const command = motion.pose[10];
    if (command === 1) throw new Failed("gave up");
    if (motion.rotation[2] > 0) return null;
    return { t: command === 2 ? NaN : motion.translation[0], a: motion.reference, b: motion.rotation, normal: [0, 0, 1] };
  }

  contacts(pose, most) {
    const depth = pose[10] === 2 ? NaN : pose[9], places = [...Array(most).keys()];
    return { points: places.map((i) => [pose[9], i, 0]), normals: places.map(() => [0, 0.6, 0.8]), depths: places.map(() => depth) };
  }

  footprint() {
    return { bytes: 12, counts: { things: 3 } };
  }
}

serve(Query, {
  name: "probe", version: "1.0", summary: "a probe", answers: ["collide", "distance", "cast", "contacts"], depth: "point",
  parameters: [choice("mode", "what fails", "none", ["none", "bad_mesh", "bad_argument"])],
});
