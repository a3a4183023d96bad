"use strict";
// three-mesh-bvh: a tree of axis-aligned boxes of each mesh (MeshBVH); surfaces only. Coordinates are doubles (JavaScript's
// numbers, Float64Array); boxes are floats.
//
// profile=default: the constructor's options, strategy CENTER. profile=tuned: strategy SAH, "the slowest construction option
// but will yield the best bounds"
// (https://github.com/gkjohnson/three-mesh-bvh/blob/master/src/core/Constants.js). Both give B's tree to the query as
// `boundsTree`; without one its queries test all of B's triangles.

const THREE = require("three");
const { MeshBVH, CENTER, SAH } = require("three-mesh-bvh");
const { serve, choice, version } = require("../javascript/sixdof_rival.js");

function tree(mesh, strategy) {
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute("position", new THREE.BufferAttribute(mesh.vertices.slice(), 3));
  geometry.setIndex(new THREE.BufferAttribute(mesh.triangles.slice(), 1));
  geometry.boundsTree = new MeshBVH(geometry, { strategy });
  geometry.computeBoundingBox();
  return geometry;
}

class Query {
  constructor(a, b, settings) {
    const strategy = settings.profile === "tuned" ? SAH : CENTER;
    this.a = tree(a, strategy);
    this.b = a === b ? this.a : tree(b, strategy);
    this.pose = new THREE.Matrix4();
  }

  set(p) {
    return this.pose.set(p[0], p[1], p[2], p[9], p[3], p[4], p[5], p[10], p[6], p[7], p[8], p[11], 0, 0, 0, 1);
  }

  collide(pose) {
    return this.a.boundsTree.intersectsGeometry(this.b, this.set(pose));
  }

  distance(pose) {
    const onA = {}, onB = {};
    this.a.boundsTree.closestPointToGeometry(this.b, this.set(pose), onA, onB);
    return { distance: onA.distance, a: onA.point.toArray(), b: onB.point.applyMatrix4(this.pose).toArray() };
  }

  footprint() {
    const both = this.a === this.b ? [this.a] : [this.a, this.b];
    return { counts: { triangles: both.reduce((sum, each) => sum + each.index.count / 3, 0) } };
  }
}

serve(Query, {
  name: "three-mesh-bvh",
  version: version("three-mesh-bvh"),
  summary: "three-mesh-bvh in Node, trees of axis-aligned boxes; surfaces only",
  answers: ["collide", "distance"],
  limits: ["collide_of_surfaces"],
  parameters: [choice("profile", "how trees are built: CENTER, or SAH", "default", ["default", "tuned"])],
});
