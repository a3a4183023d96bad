//! The same as probe.py.

use sixdof_rival::{json, serve, Contact, Failed, Impact, Mesh, Motion, Pose, Query, Refusal, Separation, Value};

struct Probe {
    sum: f64,
    copies: f64,
}

impl Query for Probe {
    fn prepare(a: &Mesh, b: &Mesh, same: bool, settings: &Value) -> Result<Self, Refusal> {
        match settings["mode"].as_str() {
            Some("bad_mesh") => return Err(Refusal::BadMesh("a bad mesh".to_string())),
            Some("bad_argument") => return Err(Refusal::BadArgument("a bad argument".to_string())),
            _ => {}
        }
        let vertices: f64 = a.vertices.iter().flatten().sum();
        let triangles: u32 = b.triangles.iter().flatten().sum();
        Ok(Probe { sum: vertices + f64::from(triangles), copies: f64::from(u8::from(same)) })
    }

    fn collide(&mut self, pose: &Pose) -> Result<bool, Failed> {
        Ok(pose[9] < 0.0)
    }

    fn distance(&mut self, pose: &Pose) -> Result<Separation, Failed> {
        match pose[10] as i64 {
            1 => return Err(Failed::because("gave up")),
            2 => return Ok(Separation { distance: f64::NAN, closest: None }),
            3 => println!("a library prints"),
            4 => panic!("a library throws"),
            _ => {}
        }
        let closest = Some(([pose[9], 0.0, 0.0], [0.0, 0.0, self.copies]));
        Ok(Separation { distance: pose[9] + self.sum, closest })
    }

    fn cast(&mut self, motion: &Motion) -> Result<Option<Impact>, Failed> {
        let command = motion.start[10];
        if command == 1.0 {
            return Err(Failed::because("gave up"));
        }
        if motion.rotation[2] > 0.0 {
            return Ok(None);
        }
        let t = if command == 2.0 { f64::NAN } else { motion.translation[0] };
        Ok(Some(Impact { t, points: Some((motion.reference, motion.rotation)), normal: Some([0.0, 0.0, 1.0]) }))
    }

    fn contacts(&mut self, pose: &Pose, most: usize) -> Result<Vec<Contact>, Failed> {
        let depth = if pose[10] == 2.0 { f64::NAN } else { pose[9] };
        let contact = |i: usize| Contact { point: [pose[9], i as f64, 0.0], normal: [0.0, 0.6, 0.8], depth };
        Ok((0..most).map(contact).collect())
    }

    fn footprint(&self) -> (usize, Value) {
        (12, json!({"things": 3}))
    }
}

fn main() {
    serve::<Probe>(json!({
        "name": "probe",
        "version": "1.0",
        "summary": "a probe",
        "answers": ["collide", "distance", "cast", "contacts"],
        "depth": "point",
        "parameters": [{"name": "mode", "meaning": "what fails", "unit": "1", "default": "none",
                        "choices": ["none", "bad_mesh", "bad_argument"]}],
    }));
}
