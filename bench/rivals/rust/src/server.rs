use std::any::Any;
use std::hint::black_box;
use std::io::{BufRead, Write};
use std::panic::{catch_unwind, AssertUnwindSafe};
use std::time::Instant;

use serde_json::{json, Map, Value};

use crate::system::{processor_ns, take_standard_output, Progress};
use crate::{Contact, Failed, Impact, Mesh, Motion, Point, Pose, Query, Refusal, Response, Separation};

const MOST_WORDS: usize = 400;

/// Answers requests until the input ends. `description` has the keys of the reply to hello: `name`, `version`,
/// `summary`, `answers`, and optional `law`, `depth`, `body`, `limits`, `parameters`. A panic of the library is a failed query.
pub fn serve<Q: Query>(description: Value) {
    let mut hello = description;
    hello["protocol"] = json!(1);
    hello["can"] = json!(["time", "progress"]);
    std::panic::set_hook(Box::new(|_| {}));
    let mut replies = take_standard_output();
    let mut server: Server<Q> = Server { hello, query: None, progress: None };
    for line in std::io::stdin().lock().lines() {
        let Ok(line) = line else { return };
        let reply = server.reply(&line).unwrap_or_else(|refusal| match refusal {
            Refusal::BadMesh(words) => json!({"error": cut(words), "kind": "bad_mesh"}),
            Refusal::BadArgument(words) => json!({"error": cut(words), "kind": "bad_argument"}),
            Refusal::Other(words) => json!({"error": cut(words), "kind": "error"}),
        });
        if writeln!(replies, "{reply}").is_err() {
            return;
        }
    }
}

type Reply = Result<Value, Refusal>;

struct Server<Q: Query> {
    hello: Value,
    query: Option<Q>,
    progress: Option<Progress>,
}

impl<Q: Query> Server<Q> {
    fn reply(&mut self, line: &str) -> Reply {
        let request: Value = serde_json::from_str(line).map_err(other)?;
        match request["do"].as_str() {
            Some("hello") if request["protocol"] == 1 => Ok(self.hello.clone()),
            Some("hello") => Err(other(format!("not version {} of the protocol", request["protocol"]))),
            Some("prepare") => self.prepare(&request),
            Some("ask") => self.ask(&request),
            Some("time") => self.time(&request),
            _ => Err(other(format!("{} is not known", request["do"]))),
        }
    }

    fn prepare(&mut self, request: &Value) -> Reply {
        self.query = None;
        self.progress = match request["progress"].as_str() {
            Some(path) => Some(Progress::open(path).map_err(other)?),
            None => None,
        };
        let (place_a, place_b) = (&request["a"], &request["b"]);
        let same = place_a["vertices"] == place_b["vertices"] && place_a["triangles"] == place_b["triangles"];
        let (a, b) = (read_mesh(place_a)?, read_mesh(place_b)?);
        let mut settings = Map::new();
        for parameter in self.hello["parameters"].as_array().into_iter().flatten() {
            settings.insert(parameter["name"].as_str().unwrap_or_default().to_string(), parameter["default"].clone());
        }
        settings.extend(request["settings"].as_object().cloned().unwrap_or_default());
        let settings = Value::Object(settings);
        let (start, cpu) = (Instant::now(), processor_ns());
        let query = catch_unwind(|| Q::prepare(&a, &b, same, &settings)).unwrap_or_else(|panic| Err(other(text(panic))))?;
        let (ns, cpu_ns) = (nanoseconds(start), processor_ns() - cpu);
        let (bytes, counts) = query.footprint();
        self.query = Some(query);
        Ok(json!({"prepared": true, "ns": ns, "cpu_ns": cpu_ns, "bytes": bytes, "counts": counts}))
    }

    fn ask(&mut self, request: &Value) -> Reply {
        let pose = pose_of(&request["pose"])?;
        let (took, answer) = match request["query"].as_str() {
            Some("cast") => timed_cast(self.prepared()?, &motion_of(request, pose)?),
            Some("contacts") => {
                let most = request["most"].as_u64().ok_or_else(|| other("no \"most\""))? as usize;
                timed(self.prepared()?, Kind::Contacts(most), &pose)
            }
            _ => timed(self.prepared()?, kind_of(request)?, &pose),
        };
        let mut reply = answer.unwrap_or_else(|e| json!({"status": e.status, "words": cut(e.words)}));
        reply["ns"] = json!(took);
        Ok(reply)
    }

    fn time(&mut self, request: &Value) -> Reply {
        let kind = kind_of(request)?;
        let poses = request["poses"].as_array().ok_or_else(|| other("no poses"))?;
        let poses = poses.iter().map(pose_of).collect::<Result<Vec<Pose>, _>>()?;
        let passes = request["passes"].as_u64().ok_or_else(|| other("no passes"))? as usize;
        let evict = request["evict_bytes"].as_u64().unwrap_or(0) as usize;
        self.prepared()?;
        match request["each"].as_bool() {
            Some(true) => self.time_each(kind, &poses, passes, evict),
            _ => self.time_passes(kind, &poses, passes),
        }
    }

    fn time_each(&mut self, kind: Kind, poses: &[Pose], passes: usize, evict_bytes: usize) -> Reply {
        let buffer = vec![1u64; evict_bytes / 8];
        let (mut once, mut least) = (vec![], vec![f64::INFINITY; poses.len()]);
        let mut failed: Vec<Option<Value>> = vec![None; poses.len()];
        for pass in 0..passes {
            for (i, pose) in poses.iter().enumerate() {
                self.begin(pass * poses.len() + i + 1);
                black_box(buffer.iter().step_by(8).sum::<u64>()); // one number of each cache line
                let (took, answer) = timed(self.prepared()?, kind, pose);
                if pass == 0 {
                    once.push(took);
                }
                least[i] = took.min(least[i]);
                if let Err(e) = answer {
                    failed[i].get_or_insert_with(|| json!([i, e.status, cut(e.words)]));
                }
            }
        }
        Ok(json!({"once_ns": once, "least_ns": least, "failed": failed.into_iter().flatten().collect::<Vec<_>>()}))
    }

    fn time_passes(&mut self, kind: Kind, poses: &[Pose], passes: usize) -> Reply {
        let (start, cpu) = (Instant::now(), processor_ns());
        for pass in 0..passes {
            for (i, pose) in poses.iter().enumerate() {
                self.begin(pass * poses.len() + i + 1);
                let query = self.prepared()?;
                let _ = black_box(ask_guarded(query, kind, pose));
            }
        }
        Ok(json!({"wall_ns": nanoseconds(start), "cpu_ns": processor_ns() - cpu}))
    }

    fn begin(&self, number: usize) {
        if let Some(progress) = &self.progress {
            progress.set(number as u64);
        }
    }

    fn prepared(&mut self) -> Result<&mut Q, Refusal> {
        self.query.as_mut().ok_or_else(|| Refusal::BadArgument("nothing is prepared".to_string()))
    }
}

#[derive(Clone, Copy)]
enum Kind {
    Collide,
    Distance,
    Respond,
    Contacts(usize),
}

enum Answer {
    Collide(bool),
    Distance(Separation),
    Respond(Response),
    Contacts(Vec<Contact>),
}

/// Of those that are asked by poses alone.
fn kind_of(request: &Value) -> Result<Kind, Refusal> {
    match request["query"].as_str() {
        Some("collide") => Ok(Kind::Collide),
        Some("distance") => Ok(Kind::Distance),
        Some("respond") => Ok(Kind::Respond),
        _ => Err(Refusal::BadArgument(format!("{} is no kind of query", request["query"]))),
    }
}

fn ask_guarded<Q: Query>(query: &mut Q, kind: Kind, pose: &Pose) -> Result<Answer, Failed> {
    let ask = AssertUnwindSafe(|| match kind {
        Kind::Collide => query.collide(pose).map(Answer::Collide),
        Kind::Distance => query.distance(pose).map(Answer::Distance),
        Kind::Respond => query.respond(pose).map(Answer::Respond),
        Kind::Contacts(most) => query.contacts(pose, most).map(Answer::Contacts),
    });
    catch_unwind(ask).unwrap_or_else(|panic| Err(Failed::because(text(panic))))
}

/// Wall time of a query in ns, and its reply.
fn timed<Q: Query>(query: &mut Q, kind: Kind, pose: &Pose) -> (f64, Result<Value, Failed>) {
    if !pose.iter().all(|x| x.is_finite()) {
        return (0.0, Err(Failed { status: "non_finite", words: "the pose is not finite".to_string() }));
    }
    let start = Instant::now();
    let answer = black_box(ask_guarded(query, kind, pose));
    (nanoseconds(start), answer.and_then(reply_of))
}

/// The same of a cast.
fn timed_cast<Q: Query>(query: &mut Q, motion: &Motion) -> (f64, Result<Value, Failed>) {
    let vectors = [&motion.translation, &motion.rotation, &motion.reference];
    if !motion.start.iter().chain(vectors.into_iter().flatten()).all(|x| x.is_finite()) {
        return (0.0, Err(Failed { status: "non_finite", words: "the motion is not finite".to_string() }));
    }
    let start = Instant::now();
    let ask = AssertUnwindSafe(|| query.cast(motion));
    let answer = black_box(catch_unwind(ask).unwrap_or_else(|panic| Err(Failed::because(text(panic)))));
    (nanoseconds(start), answer.and_then(impact_reply))
}

fn impact_reply(impact: Option<Impact>) -> Result<Value, Failed> {
    let Some(impact) = impact else { return Ok(json!({"hit": false})) };
    if !impact.t.is_finite() {
        return Err(Failed { status: "non_finite", words: "the answer is not finite".to_string() });
    }
    let mut reply = json!({"hit": true, "t": impact.t});
    let is_finite = |p: &Point| p.iter().all(|x| x.is_finite());
    if let Some((a, b)) = impact.points.filter(|(a, b)| is_finite(a) && is_finite(b)) {
        reply["a"] = json!(a);
        reply["b"] = json!(b);
    }
    if let Some(normal) = impact.normal.filter(is_finite) {
        reply["normal"] = json!(normal);
    }
    Ok(reply)
}

/// JSON has no numbers that are not finite: such an answer is a status.
fn reply_of(answer: Answer) -> Result<Value, Failed> {
    let finite = |points: &[&Point], numbers: &[f64]| {
        if points.iter().flat_map(|p| p.iter()).chain(numbers).all(|x| x.is_finite()) {
            return Ok(());
        }
        Err(Failed { status: "non_finite", words: "the answer is not finite".to_string() })
    };
    match answer {
        Answer::Collide(yes) => Ok(json!({"collide": yes})),
        Answer::Distance(Separation { distance, closest: None }) => {
            finite(&[], &[distance]).map(|()| json!({"distance": distance}))
        }
        Answer::Distance(Separation { distance, closest: Some((a, b)) }) => {
            finite(&[&a, &b], &[distance]).map(|()| json!({"distance": distance, "a": a, "b": b}))
        }
        Answer::Respond(r) => {
            finite(&[&r.force, &r.torque, &r.reference], &[r.penalty, r.volume.unwrap_or(0.0)])?;
            let mut reply =
                json!({"penalty": r.penalty, "force": r.force, "torque": r.torque, "reference": r.reference});
            if let Some(volume) = r.volume {
                reply["volume"] = json!(volume);
            }
            Ok(reply)
        }
        Answer::Contacts(list) => {
            for each in &list {
                finite(&[&each.point, &each.normal], &[each.depth])?;
            }
            Ok(json!({
                "points": list.iter().map(|each| each.point).collect::<Vec<_>>(),
                "normals": list.iter().map(|each| each.normal).collect::<Vec<_>>(),
                "depths": list.iter().map(|each| each.depth).collect::<Vec<_>>(),
            }))
        }
    }
}

fn read_mesh(place: &Value) -> Result<Mesh, Refusal> {
    let (vertices, triangles) = (rows(place, "vertices", "vertex_count", 8)?, rows(place, "triangles", "triangle_count", 4)?);
    let number = |b: &[u8]| f64::from_le_bytes(b.try_into().unwrap());
    let index = |b: &[u8]| u32::from_le_bytes(b.try_into().unwrap());
    Ok(Mesh {
        name: place["name"].as_str().unwrap_or_default().to_string(),
        vertices: vertices.chunks_exact(24).map(|r| [&r[..8], &r[8..16], &r[16..]].map(number)).collect(),
        triangles: triangles.chunks_exact(12).map(|r| [&r[..4], &r[4..8], &r[8..]].map(index)).collect(),
    })
}

/// The bytes of a file of rows of three numbers.
fn rows(place: &Value, path: &str, count: &str, size: usize) -> Result<Vec<u8>, Refusal> {
    let (path, count) = (place[path].as_str().unwrap_or_default(), place[count].as_u64().unwrap_or(0) as usize);
    let mut bytes = std::fs::read(path).map_err(|e| other(format!("{path}: {e}")))?;
    if bytes.len() < 3 * size * count {
        return Err(other(format!("{path}: fewer than {count} rows")));
    }
    bytes.truncate(3 * size * count);
    Ok(bytes)
}

fn pose_of(json: &Value) -> Result<Pose, Refusal> {
    let numbers = json.as_array().filter(|list| list.len() == 12).ok_or_else(|| other("a pose does not have twelve numbers"))?;
    let mut pose = [0.0; 12];
    for (value, json) in pose.iter_mut().zip(numbers) {
        *value = number_of(json)?;
    }
    Ok(pose)
}

fn motion_of(request: &Value, start: Pose) -> Result<Motion, Refusal> {
    let vector = |key: &str| -> Result<Point, Refusal> {
        let numbers = request[key].as_array().filter(|list| list.len() == 3);
        let numbers = numbers.ok_or_else(|| other(format!("{key} does not have three numbers")))?;
        let mut point = [0.0; 3];
        for (value, json) in point.iter_mut().zip(numbers) {
            *value = number_of(json)?;
        }
        Ok(point)
    };
    let (translation, rotation) = (vector("translation")?, vector("rotation")?);
    Ok(Motion { start, translation, rotation, reference: vector("reference")? })
}

fn number_of(json: &Value) -> Result<f64, Refusal> {
    let text = json.as_str().and_then(|word| word.parse().ok()); // "nan", "inf", "-inf"
    json.as_f64().or(text).ok_or_else(|| other(format!("{json} is no number")))
}

fn nanoseconds(start: Instant) -> f64 {
    start.elapsed().as_nanos() as f64
}

fn other(words: impl ToString) -> Refusal {
    Refusal::Other(words.to_string())
}

/// Words of a panic.
fn text(panic: Box<dyn Any + Send>) -> String {
    let words = panic.downcast_ref::<&str>().map(|s| s.to_string());
    words.or_else(|| panic.downcast_ref::<String>().cloned()).unwrap_or_else(|| "panic".to_string())
}

fn cut(words: String) -> String {
    words.chars().take(MOST_WORDS).collect()
}
