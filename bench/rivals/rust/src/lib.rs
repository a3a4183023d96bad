//! The server loop of an algorithm in Rust: [`serve`] answers the protocol of lib/sixdof/process/README.md.
//!
//! A type that implements [`Query`] is one prepared pair of meshes. A query is timed from the twelve numbers of the pose
//! to its return.

mod server;
mod system;

pub use serde_json::{json, Value};
pub use server::serve;

/// Rotation matrix by rows, then the translation: a point p of B is at R p + t in A.
pub type Pose = [f64; 12];
pub type Point = [f64; 3];

pub struct Mesh {
    pub name: String,
    pub vertices: Vec<Point>,
    pub triangles: Vec<[u32; 3]>,
}

impl Mesh {
    /// Centre of the vertices' box. B's is where torques are taken about, by convention.
    pub fn box_centre(&self) -> Point {
        let mut low = [f64::INFINITY; 3];
        let mut high = [f64::NEG_INFINITY; 3];
        for v in &self.vertices {
            for i in 0..3 {
                low[i] = low[i].min(v[i]);
                high[i] = high[i].max(v[i]);
            }
        }
        [0, 1, 2].map(|i| 0.5 * (low[i] + high[i]))
    }
}

/// Where a point of B is in A's frame.
pub fn moved(pose: &Pose, p: Point) -> Point {
    [0, 1, 2].map(|i| pose[3 * i] * p[0] + pose[3 * i + 1] * p[1] + pose[3 * i + 2] * p[2] + pose[9 + i])
}

/// A motion of B from t = 0 to 1: the point `reference` of B moves by t `translation`, and B rotates about it by t times
/// the vector `rotation` (radians); both in A's axes.
pub struct Motion {
    pub start: Pose,
    pub translation: Point,
    pub rotation: Point,
    pub reference: Point,
}

/// No answer: `status` is one of query/README.md.
pub struct Failed {
    pub status: &'static str,
    pub words: String,
}

impl Failed {
    /// The library gave up.
    pub fn because(words: impl ToString) -> Self {
        Failed { status: "failed", words: words.to_string() }
    }
    fn unsupported() -> Self {
        Failed { status: "unsupported", words: "not a question for this algorithm".to_string() }
    }
}

/// Why a pair cannot be prepared.
pub enum Refusal {
    BadMesh(String),
    BadArgument(String),
    Other(String),
}

/// Points are in A's frame.
pub struct Separation {
    pub distance: f64,
    pub closest: Option<(Point, Point)>,
}

/// The first contact of a motion, at `t` from 0 to 1: a point on A, one on B, and the normal from A to B, in A's frame.
pub struct Impact {
    pub t: f64,
    pub points: Option<(Point, Point)>,
    pub normal: Option<Point>,
}

/// A place where the bodies touch or overlap, in A's frame.
pub struct Contact {
    pub point: Point,
    /// Unit length, from A to B.
    pub normal: Point,
    pub depth: f64,
}

/// What pushes B out of A, in A's frame; the torque is about `reference`.
pub struct Response {
    pub penalty: f64,
    pub force: Point,
    pub torque: Point,
    pub reference: Point,
    pub volume: Option<f64>,
}

/// A response of contacts by the rule of algorithm/contact_wrench.h: the mean over all contacts of depth * normal at
/// the contact's point; the penalty is the largest depth. A depth below 0 counts as 0.
pub struct ContactWrench {
    sum: Response,
    count: usize,
}

impl ContactWrench {
    pub fn new(reference: Point) -> Self {
        let sum = Response { penalty: 0.0, force: [0.0; 3], torque: [0.0; 3], reference, volume: None };
        ContactWrench { sum, count: 0 }
    }

    /// `normal` has unit length and leads B out of A.
    pub fn add(&mut self, point: Point, normal: Point, depth: f64) {
        let depth = if depth < 0.0 { 0.0 } else { depth }; // a NaN stays one
        let force = normal.map(|x| depth * x);
        let arm = [0, 1, 2].map(|i| point[i] - self.sum.reference[i]);
        for i in 0..3 {
            let (j, k) = ((i + 1) % 3, (i + 2) % 3);
            self.sum.force[i] += force[i];
            self.sum.torque[i] += arm[j] * force[k] - arm[k] * force[j];
        }
        self.sum.penalty = self.sum.penalty.max(depth);
        self.count += 1;
    }

    pub fn response(mut self) -> Response {
        let scale = 1.0 / self.count.max(1) as f64;
        self.sum.force = self.sum.force.map(|x| x * scale);
        self.sum.torque = self.sum.torque.map(|x| x * scale);
        self.sum
    }
}

/// One prepared pair of meshes.
pub trait Query: Sized {
    /// `settings` has a text for every parameter of the description.
    fn prepare(a: &Mesh, b: &Mesh, same: bool, settings: &Value) -> Result<Self, Refusal>;
    fn collide(&mut self, _pose: &Pose) -> Result<bool, Failed> {
        Err(Failed::unsupported())
    }
    fn distance(&mut self, _pose: &Pose) -> Result<Separation, Failed> {
        Err(Failed::unsupported())
    }
    fn respond(&mut self, _pose: &Pose) -> Result<Response, Failed> {
        Err(Failed::unsupported())
    }
    /// The first contact, none if there is none.
    fn cast(&mut self, _motion: &Motion) -> Result<Option<Impact>, Failed> {
        Err(Failed::unsupported())
    }
    /// At most `most` contacts.
    fn contacts(&mut self, _pose: &Pose, _most: usize) -> Result<Vec<Contact>, Failed> {
        Err(Failed::unsupported())
    }
    /// Bytes, and an object of counts.
    fn footprint(&self) -> (usize, Value) {
        (0, json!({}))
    }
}
