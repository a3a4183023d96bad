//! parry3d-f64: yes/no, distance, contacts and first contacts of two TriMesh, surfaces only, in double precision.
//!
//! cast: `cast_shapes()` for a motion that does not rotate, `cast_shapes_nonlinear()` for one that does; `nonlinear`: the
//! latter for all. NonlinearRigidMotion is the motion that is asked. Default options: contact at the start is a hit. A hit
//! whose status is OutOfIterations or Failed counts, since parry says that it is conservative
//! (https://docs.rs/parry3d-f64/0.31.1/parry3d_f64/query/enum.ShapeCastStatus.html). Points and normals of contact at the
//! start are not given: those of nonlinear casts are the bodies' origins.
//!
//! profile=default: the free functions of `query`, and contact manifolds computed anew. profile=tuned: the manifolds and
//! the workspace of the query before are given back, since "this persistence can significantly improve collision detection
//! performances" (https://docs.rs/parry3d-f64/0.31.1/parry3d_f64/query/trait.PersistentQueryDispatcher.html), and meshes
//! have FIX_INTERNAL_EDGES and ORIENTED, for "contacts normals that could lead to incorrect bumps"
//! (https://docs.rs/parry3d-f64/0.31.1/parry3d_f64/shape/struct.TriMeshFlags.html).

use std::sync::Arc;

use parry3d_f64::math::{Mat3, Pose as Isometry, Rotation, Vector};
use parry3d_f64::query::details::ContactManifoldsWorkspace;
use parry3d_f64::query::{self, ClosestPoints, ContactManifold, DefaultQueryDispatcher, PersistentQueryDispatcher};
use parry3d_f64::query::{NonlinearRigidMotion, ShapeCastOptions, ShapeCastStatus};
use parry3d_f64::shape::{TriMesh, TriMeshFlags};
use sixdof_rival::{json, moved, serve, Contact, ContactWrench, Failed, Impact, Mesh, Motion, Point, Pose, Query, Refusal};
use sixdof_rival::{Response, Separation, Value};

struct Parry {
    a: Arc<TriMesh>,
    b: Arc<TriMesh>,
    centre_b: Point,
    tuned: bool,
    points: bool,
    nonlinear: bool,
    manifolds: Vec<ContactManifold<(), ()>>,
    workspace: Option<ContactManifoldsWorkspace>,
}

fn trimesh(mesh: &Mesh, flags: TriMeshFlags) -> Result<Arc<TriMesh>, Refusal> {
    let vertices = mesh.vertices.iter().map(|&v| Vector::from(v)).collect();
    let built = TriMesh::with_flags(vertices, mesh.triangles.clone(), flags);
    built.map(Arc::new).map_err(|e| Refusal::BadMesh(format!("{}: {e}", mesh.name)))
}

fn isometry(p: &Pose) -> Isometry {
    let rotation = Mat3::from_cols_array(&[p[0], p[3], p[6], p[1], p[4], p[7], p[2], p[5], p[8]]);
    Isometry::from_parts(Vector::new(p[9], p[10], p[11]), Rotation::from_mat3(&rotation))
}

impl Parry {
    fn find_manifolds(&mut self, pose: &Pose) -> Result<(), Failed> {
        if !self.tuned {
            self.manifolds.clear();
            self.workspace = None;
        }
        DefaultQueryDispatcher
            .contact_manifolds(&isometry(pose), &*self.a, &*self.b, 0.0, &mut self.manifolds, &mut self.workspace)
            .map_err(Failed::because)
    }
}

impl Query for Parry {
    fn prepare(a: &Mesh, b: &Mesh, same: bool, settings: &Value) -> Result<Self, Refusal> {
        let tuned = settings["profile"] == "tuned";
        let edges = TriMeshFlags::FIX_INTERNAL_EDGES | TriMeshFlags::ORIENTED;
        let flags = if tuned { edges } else { TriMeshFlags::empty() };
        let tree_a = trimesh(a, flags)?;
        let tree_b = if same { tree_a.clone() } else { trimesh(b, flags)? };
        let points = settings["points"] == "on";
        let nonlinear = settings["cast"] == "nonlinear";
        let centre_b = b.box_centre();
        Ok(Parry { a: tree_a, b: tree_b, centre_b, tuned, points, nonlinear, manifolds: vec![], workspace: None })
    }

    fn collide(&mut self, pose: &Pose) -> Result<bool, Failed> {
        query::intersection_test(&Isometry::IDENTITY, &*self.a, &isometry(pose), &*self.b)
            .map(|test| test.intersecting)
            .map_err(Failed::because)
    }

    fn distance(&mut self, pose: &Pose) -> Result<Separation, Failed> {
        let pose_b = isometry(pose);
        if !self.points {
            return query::distance(&Isometry::IDENTITY, &*self.a, &pose_b, &*self.b)
                .map(|found| Separation { distance: found.distance, closest: None })
                .map_err(Failed::because);
        }
        match query::closest_points(&Isometry::IDENTITY, &*self.a, &pose_b, &*self.b, f64::MAX) {
            Ok(ClosestPoints::WithinMargin(a, b)) => {
                Ok(Separation { distance: (a - b).length(), closest: Some((a.into(), b.into())) })
            }
            Ok(ClosestPoints::Intersecting) => Ok(Separation { distance: 0.0, closest: None }),
            Ok(ClosestPoints::Disjoint) => Err(Failed::because("no closest points")),
            Err(e) => Err(Failed::because(e)),
        }
    }

    fn respond(&mut self, pose: &Pose) -> Result<Response, Failed> {
        self.find_manifolds(pose)?;
        let mut wrench = ContactWrench::new(moved(pose, self.centre_b));
        for manifold in &self.manifolds {
            for contact in manifold.contacts().iter().filter(|each| each.dist < 0.0) {
                wrench.add(contact.local_p1.into(), manifold.local_n1.into(), -contact.dist);
            }
        }
        Ok(wrench.response())
    }

    fn cast(&mut self, motion: &Motion) -> Result<Option<Impact>, Failed> {
        let start = isometry(&motion.start);
        let (reference, velocity) = (Vector::from(motion.reference), Vector::from(motion.translation));
        let rotation = Vector::from(motion.rotation);
        let moving = NonlinearRigidMotion::new(start, reference, velocity, rotation);
        let found = if rotation == Vector::ZERO && !self.nonlinear {
            let options = ShapeCastOptions::with_max_time_of_impact(1.0);
            query::cast_shapes(&Isometry::IDENTITY, Vector::ZERO, &*self.a, &start, velocity, &*self.b, options)
        } else {
            let still = NonlinearRigidMotion::identity();
            query::cast_shapes_nonlinear(&still, &*self.a, &moving, &*self.b, 0.0, 1.0, true)
        };
        Ok(found.map_err(Failed::because)?.map(|hit| {
            if hit.status == ShapeCastStatus::PenetratingOrWithinTargetDist {
                return Impact { t: hit.time_of_impact, points: None, normal: None };
            }
            let on_b = moving.position_at_time(hit.time_of_impact) * hit.witness2;
            let points = Some((hit.witness1.into(), on_b.into()));
            Impact { t: hit.time_of_impact, points, normal: Some(hit.normal1.into()) }
        }))
    }

    /// The first that it finds. Points on A; parry's margin is 0, so a distance above 0 is no contact.
    fn contacts(&mut self, pose: &Pose, most: usize) -> Result<Vec<Contact>, Failed> {
        self.find_manifolds(pose)?;
        let each = self.manifolds.iter().flat_map(|manifold| {
            manifold.contacts().iter().map(|contact| (contact, manifold.local_n1))
        });
        let inside = each.filter(|(contact, _)| contact.dist < 0.0).take(most);
        Ok(inside.map(|(c, n)| Contact { point: c.local_p1.into(), normal: n.into(), depth: -c.dist }).collect())
    }

    fn footprint(&self) -> (usize, Value) {
        let shared = Arc::ptr_eq(&self.a, &self.b);
        let triangles = self.a.num_triangles() + if shared { 0 } else { self.b.num_triangles() };
        (0, json!({"triangles": triangles}))
    }
}

fn choice(name: &str, meaning: &str, default: &str, choices: &[&str]) -> Value {
    json!({"name": name, "meaning": meaning, "unit": "1", "default": default, "choices": choices})
}

fn main() {
    serve::<Parry>(json!({
        "name": "parry",
        "version": "0.31.1",
        "summary": "parry3d-f64, two TriMesh; surfaces only",
        "answers": ["collide", "distance", "respond", "cast", "contacts"],
        "law": "contacts",
        "depth": "triangles",
        "limits": ["collide_of_surfaces", "respond_of_surfaces", "own_direction"],
        "parameters": [
            choice("profile", "anew each query; or contacts kept, internal edges fixed", "default", &["default", "tuned"]),
            choice("points", "distance with closest points", "off", &["off", "on"]),
            choice("cast", "linear cast where nothing rotates; or nonlinear always", "linear", &["linear", "nonlinear"]),
        ],
    }));
}
