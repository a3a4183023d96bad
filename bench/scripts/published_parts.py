"""What `bench/publish` measures: its parts, the commands of each, and what of their results is kept.

Whole results stand in the folder of a run. bench/published/PART/FILE.json has them in short: the same formats, which
`sixdof table` and `sixdof report` read, with the fields and counters below only. bench/published/parts.json says of each part
commit, date, machine and commands.
"""

import dataclasses
import json
import pathlib

ROOT = pathlib.Path(__file__).resolve().parents[2]

# Counters of rows that tables and figures show. All others, and the worst configurations of rows, stay in the run.
KEPT = ["name", "run_name", "run_type", "sixdof", "error_occurred", "error_message", "real_time", "cpu_time", "time_unit",
        "cpu_time_low", "cpu_time_high", "configurations", "judged", "failed", "crashed", "timed_out", "out_of_memory",
        "mismatch", "misses", "p50_ns", "p99_ns", "p999_ns", "p99_least_ns", "p999_least_ns", "max_ns", "max_least_ns",
        "over_1ms", "error_rms", "error_max", "gamma_F_deg", "gamma_F_deg_low", "gamma_F_deg_high", "gamma_F_p95_deg",
        "gamma_max_F_deg", "gamma_T_deg", "magnitude_error_F", "magnitude_error_T", "volume_error_mean", "bytes",
        "prepare_ns", "ns_per_configuration", "triangles", "on_frontier", "label", "empty_call_ns", "tau_ns", "measured_ns",
        "eta_measured", "eta_predicted", "sigma_F", "sigma_T", "nu_F", "nu_T", "noise_F", "noise_T", "leakage", "jump_F",
        "jump_T", "loop_work", "lag", "steps", "nu_direction_F", "nu_direction_T", "sigma_q",
        "gamma_own_F_deg", "gamma_own_T_deg", "magnitude_error_own_F", "magnitude_error_own_T", "unjudged_own", "phantoms",
        "phantom_force_mean", "phantom_force_max", "voxels_x", "voxels_y", "voxels_z", "points", "spheres_a", "spheres_b",
        # first contacts
        "early", "early_max", "late_hits", "late_max", "missed_hits", "phantom_hits", "false_starts", "grazing", "hits",
        "normal_max_deg",
        # contacts and depths
        "contacts_mean", "contact_off_mean", "off_bodies", "contact_normal_deg", "reversed_normals", "contact_force_deg",
        "contact_depth_ratio", "uncovered_mean", "astray_mean", "exchange_flips", "exchange_points", "moved_flips", "moved_points",
        "without_contact", "depth_ratio", "too_shallow", "too_deep", "missed_depths", "too_shallow_max", "too_deep_max",
        "open_depths", "depth_width_max",
        # scenes of meshes that deform
        "amplitude", "processor_ns", "update_ns", "answer_ns", "p99_frame_ns", "built_triangles", "missed_pairs", "wrong_pairs",
        "bodies"]
DIGITS = 4  # Significant digits of the numbers that are kept.
# Numbers of configurations, which are kept whole.
COUNTS = {"configurations", "judged", "failed", "mismatch", "misses", "phantoms"}
FCL = ["fcl-obbrss", "fcl-rss", "fcl-kios", "fcl-obb", "fcl-contacts"]
# Rivals whose queries take milliseconds or less, and those that take up to seconds on large meshes.
FAST_RIVALS = ["coal", "drake", "jolt", "mujoco", "python-fcl", "vtk"]
SLOW_RIVALS = ["manifold", "mujoco-sdf", "parry", "three-mesh-bvh"]
APPROXIMATE = ["ist", "ist-descent", "vps", "vps-field"]
# GTS is left out: it ends with an assertion at many poses of the paths.
ALONG_PATHS = ["exact", "fcl-contacts", "bullet-gimpact", "ode", "simbody", *APPROXIMATE]
SETS = ["elephant", "bunny", "armadillo", "ship", "torus-knot-1m"]
FOUR_PAIRS = ["elephant", "bunny", "ship", "torus-knot-1m"]
DEPTH_PAIRS = ["bunny", "elephant", "ship", "torus-knot-10k", "gyroid-ball-10k-circular-box-10k", "armadillo"]
CONTACTS = ["exact-contacts", "fcl-contacts", "bullet-gimpact", "ode", "coal", "mujoco-sdf", "parry", "python-fcl"]
# Simbody is left out: a query of meshes takes seconds to minutes.
DEPTHS = [*CONTACTS, "exact-penetration", "vps", "vps-field"]
# Not on torus-knot-1m, whose hull has 72,155 corners: 19 minutes were not enough for the truth of 16 poses.
HULL_DEPTHS = ["ccd-hull", "drake", "mujoco"]
SCENES = ["cube", "pairs", "pile", "robot", "dust", "still", "all-move", "giant", "clusters", "shuffled"]
LARGE_SCENES = ["cube", "shuffled", "dust"]
GENERATED = "elephant|bunny|torus-knot-(10k|100k|1m)"


@dataclasses.dataclass(frozen=True)
class Step:
    """One command, and the file that it leaves in the folder of the run."""
    file: str
    command: list    # {out} stands for the file, {folder} for the folder of the run.
    minutes: float   # That it takes on two cores of 2.5 GHz; for --plan.
    resumes: bool = False  # A program that writes FILE.journal and continues it with --resume.
    prints: bool = False   # What the command prints is the file.


@dataclasses.dataclass(frozen=True)
class Part:
    name: str
    about: str
    steps: list
    setup: tuple = ()  # A command that installs what is measured; what it cannot install is not measured.

    @property
    def minutes(self):
        return sum(step.minutes for step in self.steps)


def rows(file, minutes, *words):
    """A step of sixdof-bench on committed sets."""
    return Step(file, ["sixdof-bench", *words, "{out}"], minutes, resumes=True)


def respond_rows(file, minutes, order, *words):
    sets = [word for name in SETS for word in ("--set", f"fixtures/{name}.h5")]
    return rows(file, minutes, "--no-manifest", *sets, "--sample", "128",
                f"--benchmark_filter=^respond/algorithm:exact/.*volume:(01|10){order}$", *words)


def object_steps(script, minutes, *words, algorithms=("exact", *FCL, "bullet-gimpact", "ode", *APPROXIMATE)):
    """Steps of bench/scripts/collection or growth: the measurement, and its tables."""
    folder = ["--out", f"{{folder}}/{script}"]
    algorithms = ",".join(algorithms)
    return [Step(f"{script}/{'results' if script == 'collection' else script}.json",
                 [f"bench/scripts/{script}", *folder, "--jobs", "2", "--grid", "so3:4:2", "--sample", "8", *words, "--algorithms",
                  algorithms, "--budget", f"{minutes}min"], minutes),
            Step(f"{script}/tables.txt", [f"bench/scripts/{script}", *folder, "--report"], 0.1, prints=True)]


def loss_steps():
    """Every object with three partners, and the rows in which another library is faster than `exact`."""
    others = ["fcl-obbrss", "fcl-rss", "fcl-kios", "fcl-obb", "fcl-contacts", "bullet-gimpact", "ode"]
    table = ["sixdof", "table", "{folder}/collection/results.json", "--against", ",".join(others), "--markdown", "--slower"]
    return [object_steps("collection", 40, "--partners", "self,tenth,seeded", "--distances", "0,1,10,30", "--volumes", "1,10",
                         algorithms=("exact", *others))[0],
            Step("mean.txt", [*table, "1"], 0.1, prints=True)]


def paper_steps():
    """All configurations of one set of the paper's size. The set is made first, or was made before with the same bytes."""
    return [Step("run/survey.json", ["bench/paper", "--a", "torus-200", "--out", "{folder}/run", "--jobs", "2", "--algorithms", "exact", "vps",
                                     "vps:point_spacing=0.008", "ist", "ist:spheres=1000", "--shards", "16"], 60)]


def rival_steps():
    """Two poses of a bucket are enough where a query takes seconds: 5 to 10 of them are asked of each pose."""
    slow = (f"^(collide|distance|respond)/algorithm:({'|'.join(['exact', *SLOW_RIVALS])})/"
            f"pair:({'|'.join(FOUR_PAIRS)})/(distance|volume):05$")
    tuned = "^(collide|distance)/algorithm:(exact|coal)/|^respond/algorithm:(exact|parry)/pair:elephant/volume:05$"
    fast = "|".join(["exact", "fcl-obbrss", "fcl-rss", *FAST_RIVALS])
    return [rows("rivals.json", 9, "--suite", "all-algorithms", f"--benchmark_filter=algorithm:({fast})/", "--sample", "200",
                 "--budget", "480"),
            rows("slow.json", 6, f"--benchmark_filter={slow}", "--sample", "2", "--benchmark_min_time=0.001"),
            rows("tuned.json", 5, "--suite", "all-algorithms", f"--benchmark_filter={tuned}", "-p", "rivals:profile=tuned",
                 "--sample", "200", "--budget", "240"),
            *object_steps("collection", 14, "--partners", "self", "--most-triangles", "30000", "--distances", "1,5",
                          "--volumes", "5", "--sample", "4", algorithms=("exact", "fcl-obbrss", "fcl-rss", "rivals"))]


def cast_steps():
    """Every solver of FCL, and how many motions sampling misses. Few motions where a query takes seconds: each is asked three
    times or more."""
    four = "|".join(FOUR_PAIRS)
    slow = ["-p", "fcl-cast:solver=oriented,advancement", "--benchmark_min_time=0.001"]
    return [rows("casts.json", 3, f"--benchmark_filter=^cast/algorithm:(exact|sampled|fcl-cast|bullet-hull)/pair:({four})/.*/step:10$",
                 "-p", "fcl-cast:solver=naive", "--sample", "64", "--budget", "150"),
            rows("fcl.json", 5, "--benchmark_filter=^cast/algorithm:(exact|fcl-cast@.*)/pair:(elephant|bunny|ship)/.*/step:10$", *slow,
                 "--sample", "4"),
            rows("fcl-1m.json", 4,
                 "--benchmark_filter=^cast/algorithm:(exact|fcl-cast@.*)/pair:torus-knot-1m/motion:(rotation|tumble)/step:10$", *slow,
                 "--sample", "2"),
            rows("sampled.json", 2, "--benchmark_filter=^cast/algorithm:(exact|sampled@.*)/pair:elephant/motion:tumble/step:(1|10|100)$",
                 "-p", "sampled:steps=4,16,64,256", "--sample", "512", "--budget", "90"),
            rows("parry.json", 2, "--benchmark_filter=^cast/algorithm:(exact|parry)/pair:(elephant|bunny|ship)/motion:translation/step:10$",
                 "--sample", "8", "--benchmark_min_time=0.001")]


def contact_steps():
    contacts, four = ("|".join(names) for names in (CONTACTS, FOUR_PAIRS))
    return [rows("contacts.json", 22, "--isolate=third-party",
                 f"--benchmark_filter=^contacts/algorithm:({contacts})/pair:({four})/volume:(01|10)$", "--sample", "16", "--budget", "300")]


def depth_steps():
    depths, hulls, four, six = ("|".join(names) for names in (DEPTHS, HULL_DEPTHS, FOUR_PAIRS, DEPTH_PAIRS))
    return [rows("depths.json", 6, "--isolate=third-party",
                 f"--benchmark_filter=^depth/algorithm:(({depths})/pair:({four})|({hulls})/pair:(elephant|bunny|ship))/volume:05$",
                 "--sample", "16", "--budget", "240"),
            rows("intervals.json", 5, f"--benchmark_filter=^depth/algorithm:exact-penetration/pair:({six})/volume:(01|05|10)$", "--sample",
                 "32", "--budget", "300")]


def scene_steps():
    steps = []
    for family in SCENES:
        file = f"{family}.h5"
        steps += [Step(file, ["sixdof", "scene", "make", family, "-n", "1000", "--frames", "10", "-o", "{out}"], 0.1),
                  Step(f"{family}.json", ["sixdof", "scene", "play", "{folder}/" + file, "--question",
                                          "touching,near,closest", "--threads", "1", "--json"], 0.5, prints=True)]
    for family in LARGE_SCENES:
        file = f"{family}-100k.h5"
        steps += [Step(file, ["sixdof", "scene", "make", family, "-n", "100000", "--frames", "4", "-o", "{out}"], 0.3),
                  Step(f"{family}-100k.json", ["sixdof", "scene", "play", "{folder}/" + file, "--question", "touching",
                                               "--algorithms", "exact,fcl-aabb-tree,fcl-aabb-tree-array,ode-sap",
                                               "--threads", "1", "--json"], 1.0, prints=True)]
    return steps


def plan_step(model):
    return Step(f"{model}.json", ["sixdof", "generate", "--a", model, "--grid", "paper", "--distances", "0:30", "--volumes",
                                  "0:10", "--plan", "--shards", "64", "--plan-seconds", "25", "--threads", "1", "--json"],
                0.6, prints=True)


def recommend(file, *words):
    return Step(file, ["sixdof", "recommend", "--a", "elephant", "--b", "elephant", "--deadline", "1ms", "--budget", "90s", *words], 1.5,
                prints=True)


def parts():
    """All parts, the shortest first."""
    equal_time = [Step("equivalent.json", ["sixdof", "equivalent", "--paper", "-o", "{out}"], 40, resumes=True),
                  # Of a whole file this measures nothing and prints.
                  Step("paper.txt", ["sixdof", "equivalent", "--paper", "--resume", "--output={folder}/equivalent.json",
                                     "--markdown"], 0.1, prints=True)]
    return [
        Part("stress", "hard cases: who breaks, on what",
             [Step("stress.txt", ["sixdof", "stress", "--cases", "{folder}/stress-cases"], 1.5, prints=True)]),
        Part("scenarios", "force and torque along the paper's paths, default settings",
             [rows("scenarios.json", 4, "--isolate=third-party",
                   f"--benchmark_filter=^scenario/.*:({'|'.join(ALONG_PATHS)})$")]),
        Part("precision", "run time against error on the elephants",
             [Step("precision.json", ["sixdof", "precision", "--a", "elephant", "--b", "elephant", "--budget", "4min", "-o",
                                      "{out}"], 4)]),
        Part("recommend", "the choice under a deadline of 1 ms",
             [recommend("random.txt"), recommend("threads.txt", "--threads", "2"),
              recommend("motion.txt", "--order", "motion")]),
        Part("threads", "the exact response by one and two threads, and along motions",
             [respond_rows("one.json", 0.5, ""), respond_rows("two.json", 0.5, "", "-p", "exact:threads=2"),
              respond_rows("cold.json", 0.5, "/order:motion"),
              respond_rows("warm.json", 0.5, "/order:motion", "-p", "exact:warm_start=on")]),
        Part("plan", "what sets of the paper's size would take",
             [plan_step(model) for model in ("torus-knot-10k", "elephant")]),
        Part("generate", "making a configuration: ray cast and FCL's advancement",
             [rows("generate.json", 4, f"--benchmark_filter=^generate/distance/.*:({GENERATED})$")]),
        Part("equivalent", "the paper's table: errors at equal time", equal_time),
        Part("casts", "first contact of two moving meshes", cast_steps(), setup=("bench/rivals/setup",)),
        Part("contacts", "contacts against exact geometry", contact_steps(), setup=("bench/rivals/setup",)),
        Part("depths", "penetration depths, and the intervals that judge them", depth_steps(), setup=("bench/rivals/setup",)),
        Part("scenes", "scenes of 1,000 and 100,000 bodies", scene_steps()),
        Part("deform", "meshes that deform: refitting their trees against building them anew",
             [rows("deform.json", 25, "--suite", "deform")]),
        Part("growth", "growth with the number of triangles", object_steps("growth", 10)),
        Part("pairs", "every algorithm on four pairs",
             [rows("pairs.json", 40, "--isolate=third-party", "--suite", "all-algorithms",
                   "--benchmark_filter=-algorithm:rivals/", "--sample", "200", "--budget", "900")]),
        Part("collection", "every algorithm on the objects of the collection",
             object_steps("collection", 25, "--partners", "self", "--distances", "0,1,5,20", "--volumes", "1,10")),
        Part("paper", "every configuration of a set of the paper's size", paper_steps()),
        Part("losses", "objects on which another library is faster than `exact`", loss_steps()),
        Part("rivals", "what bench/rivals/setup has made ready, on four pairs and the collection",
             rival_steps(), setup=("bench/rivals/setup",)),
    ]


def rounded(value, name=None):
    """Numbers of a JSON value with DIGITS significant digits, those of COUNTS whole."""
    if isinstance(value, bool):
        return value
    if isinstance(value, float):
        if name in COUNTS and value.is_integer():
            return int(value)
        short = float(f"{value:.{DIGITS}g}")
        return int(short) if short.is_integer() and abs(short) < 1e15 else short
    if isinstance(value, dict):
        return {key: rounded(each, key) for key, each in value.items()}
    return [rounded(each) for each in value] if isinstance(value, list) else value


def compact(document):
    """A result file in short."""
    if isinstance(document, list) or "benchmarks" not in document:  # of stress, scenes, and plans
        return rounded(document)
    short = {key: value for key, value in document.items() if key not in ("benchmarks", "context", "measurements")}
    kept = [{key: row[key] for key in KEPT if key in row} for row in document["benchmarks"]]
    if "collection" in document or "growth" in document:
        kept = []  # their summaries have what is published
    return rounded({"context": context_of(document), "benchmarks": kept, **short})


def context_of(document):
    """What a table or a page of the file needs, without this machine's paths."""
    kept = document.get("context", {})
    return {key: value for key, value in kept.items()
            if key in ("date", "num_cpus", "mhz_per_cpu", "commit", "sixdof_build", "seed", "arguments") or
            key.startswith("algorithm:") or key.startswith("settings:")}


def commands_of(part):
    """The part's command lines, without the files that they write."""
    return [" ".join(word for word in step.command if word not in ("-o", "{out}")).replace("{folder}/", "")
            for step in part.steps]


def as_text(document):
    """JSON with a line for each row, so that a change of one row is a change of one line."""
    def lines(entries):
        return "[\n" + ",\n".join(json.dumps(each, separators=(",", ":")) for each in entries) + "]"
    if isinstance(document, list):
        return lines(document) + "\n"
    if "benchmarks" not in document:
        return json.dumps(document, indent=1) + "\n"
    rest = {key: value for key, value in document.items() if key != "benchmarks"}
    inside = ",\n".join(f"{json.dumps(key)}: {json.dumps(value, separators=(',', ':'))}" for key, value in rest.items())
    return "{" + inside + ',\n"benchmarks": ' + lines(document["benchmarks"]) + "}\n"


def write_short(part, folder: pathlib.Path, published: pathlib.Path, write):
    """Writes published/PART/FILE of every result of a part, with paths from the root of this repository.
    @param write (file, text) -> None, whole or not at all"""
    for step in part.steps:
        file = folder / step.file
        if file.suffix not in (".json", ".txt"):
            continue  # a scene, which a later step reads
        text = file.read_text(encoding="utf-8").replace(f"{ROOT}/", "")
        target = published / part.name / file.name
        target.parent.mkdir(parents=True, exist_ok=True)
        write(target, as_text(compact(json.loads(text))) if file.suffix == ".json" else text)
