"use strict";
// Jolt Physics, compiled to WebAssembly: the convex hulls of both meshes, in single precision. It has no test of two meshes.
//
// collide: TransformedShape::CollideShape() of two ConvexHullShape, any hit. distance: the same with mMaxSeparationDistance,
// closest hit. A hull has at most 256 points; Jolt leaves out points within its hull tolerance of 1e-3 length units.
// `convex_radius` rounds the edges of a hull; Jolt's own default is 0.05, which is another body, so 0 is the default here.

const { serve, version, extent, BadMesh } = require("../javascript/sixdof_rival.js");

/** The tests of pairs of shapes exist once a world does. */
function registerShapes(Jolt) {
  const settings = new Jolt.JoltSettings(), layers = 1;
  settings.mObjectLayerPairFilter = new Jolt.ObjectLayerPairFilterTable(layers);
  settings.mBroadPhaseLayerInterface = new Jolt.BroadPhaseLayerInterfaceTable(layers, layers);
  settings.mObjectVsBroadPhaseLayerFilter = new Jolt.ObjectVsBroadPhaseLayerFilterTable(
    settings.mBroadPhaseLayerInterface, layers, settings.mObjectLayerPairFilter, layers);
  new Jolt.JoltInterface(settings);
}

async function main() {
  const initialise = (await import(require.resolve("jolt-physics"))).default;
  const Jolt = await initialise();
  registerShapes(Jolt);

  function hull(mesh, radius) {
    const settings = new Jolt.ConvexHullShapeSettings();
    settings.mMaxConvexRadius = radius;
    settings.mPoints.reserve(mesh.vertices.length / 3);
    const point = new Jolt.Vec3(0, 0, 0);
    for (let i = 0; i < mesh.vertices.length; i += 3) {
      point.Set(mesh.vertices[i], mesh.vertices[i + 1], mesh.vertices[i + 2]);
      settings.mPoints.push_back(point);
    }
    Jolt.destroy(point);
    const result = settings.Create();
    if (!result.IsValid()) throw new BadMesh(`${mesh.name}: ${result.HasError() ? result.GetError().c_str() : "no hull"}`);
    const shape = result.Get();
    shape.AddRef(); // Create() returns the same object each time
    Jolt.destroy(settings);
    return shape;
  }

  class Query {
    constructor(a, b, settings) {
      const radius = Number(settings.convex_radius);
      const shapeA = hull(a, radius);
      this.b = a === b ? shapeA : hull(b, radius);
      this.shapes = a === b ? [shapeA] : [shapeA, this.b];
      this.one = new Jolt.Vec3(1, 1, 1);
      this.origin = new Jolt.RVec3(0, 0, 0);
      this.a = new Jolt.TransformedShape();
      this.a.mShape = shapeA;
      this.a.mShapePositionCOM = vector(shapeA.GetCenterOfMass());
      this.a.mShapeRotation = Jolt.Quat.prototype.sIdentity();
      this.a.SetShapeScale(this.one);
      const centre = this.b.GetCenterOfMass();
      this.centreB = [centre.GetX(), centre.GetY(), centre.GetZ()];
      this.pose = new Jolt.RMat44();
      this.axis = new Jolt.Vec3(0, 0, 0);
      this.place = new Jolt.RVec3(0, 0, 0);
      this.touching = new Jolt.CollideShapeSettings();
      this.apart = new Jolt.CollideShapeSettings();
      this.apart.mMaxSeparationDistance = 4 * (extent(a) + extent(b)); // single precision: no more than is needed
      this.any = new Jolt.CollideShapeAnyHitCollisionCollector();
      this.closest = new Jolt.CollideShapeClosestHitCollisionCollector();
      this.filter = new Jolt.ShapeFilter();
    }

    release() {
      for (const key of ["one", "origin", "a", "pose", "axis", "place", "touching", "apart", "any", "closest", "filter"]) {
        Jolt.destroy(this[key]);
      }
      for (const shape of this.shapes) shape.Release();
    }

    /** Of the centre of mass of B's hull, about which Jolt's hull has its points. */
    set(p) {
      const c = this.centreB;
      this.axis.Set(p[0], p[3], p[6]);
      this.pose.SetAxisX(this.axis);
      this.axis.Set(p[1], p[4], p[7]);
      this.pose.SetAxisY(this.axis);
      this.axis.Set(p[2], p[5], p[8]);
      this.pose.SetAxisZ(this.axis);
      const at = [0, 1, 2].map((i) => p[3 * i] * c[0] + p[3 * i + 1] * c[1] + p[3 * i + 2] * c[2] + p[9 + i]);
      this.place.Set(at[0], at[1], at[2]);
      this.pose.SetTranslation(this.place);
    }

    search(pose, settings, collector) {
      this.set(pose);
      collector.Reset();
      this.a.CollideShape(this.b, this.one, this.pose, settings, this.origin, collector, this.filter);
      return collector.HadHit();
    }

    collide(pose) {
      return this.search(pose, this.touching, this.any);
    }

    distance(pose) {
      if (!this.search(pose, this.apart, this.closest)) throw new Error("farther apart than four times their size");
      const hit = this.closest.mHit; // its shape 1 is the one that is moved
      if (hit.mPenetrationDepth >= 0) return { distance: 0 };
      return { distance: -hit.mPenetrationDepth, a: numbers(hit.mContactPointOn2), b: numbers(hit.mContactPointOn1) };
    }
  }

  const numbers = (v) => [v.GetX(), v.GetY(), v.GetZ()];
  const vector = (v) => new Jolt.RVec3(...numbers(v));

  serve(Query, {
    name: "jolt",
    version: version("jolt-physics"),
    summary: "Jolt in WebAssembly: convex hulls of at most 256 points, single precision",
    answers: ["collide", "distance"],
    body: "convex_hull",
    limits: ["distance_of_bodies"],
    parameters: [{ name: "convex_radius", meaning: "radius that rounds a hull's edges", unit: "length", default: "0",
                   low: 0, high: 1 }],
  });
}

main();
