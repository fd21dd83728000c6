"""Is every result what results/result.schema.json says, and does that say enough to find a mistake?

usage: result_schema_test.py TETRACE RESULTS      (the program, the folder results/)
Exit code 77 where the package python3-jsonschema is missing.
"""

import copy
import json
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

try:
    import jsonschema
except ImportError:
    print("skipped: nothing here reads JSON Schema; install python3-jsonschema")
    sys.exit(77)

TETRACE, RESULTS = sys.argv[1], pathlib.Path(sys.argv[2])
SCHEMA = json.loads((RESULTS / "result.schema.json").read_text())
VALIDATOR = jsonschema.Draft202012Validator(SCHEMA)

CLAIM = {"id": "table4-maria", "text": "maria has no wrong result", "verdict": "holds", "evidence": "0 of 10 rays"}
TABLE = {
    "id": "table4",
    "title": "Robustness",
    "source": "Maria et al. 2017, Table 4",
    "columns": [{"key": "method", "title": "method"}, {"key": "lost", "title": "lost", "unit": "rays", "decimals": 1}],
    "rows": [{"method": "maria", "lost": {"value": 0, "low": 0, "high": 0.1, "paper": 1, "ratio": 0, "text": "none"}},
             {"method": "plane", "lost": 3}],
    "claims": [CLAIM],
    "notes": ["sampled"],
}
FIGURE = {
    "id": "figure6",
    "title": "Time and tets",
    "source": "Maria et al. 2017, Figure 6",
    "x": {"title": "tets a ray", "unit": ""},
    "y": {"title": "time", "unit": "ms"},
    "series": [{"name": "cpu", "points": [[1, 2.5], [3, 4]]}],
    "claims": [CLAIM],
    "pictures": ["figure6/slowest.png"],
    "notes": [],
}
# Variables that the program needs of its environment: where compiled kernels are, and what makes tests quick.
KEPT = ("XDG_CACHE_HOME", "POCL_CACHE_DIR", "MESA_SHADER_CACHE_DIR", "OMP_WAIT_POLICY", "TETRACE_QUICK_COPIES")
# Everything below these has keys or types of its own choice: Google Benchmark's, scenes' and devices' names, columns.
FREE_KEYS = {("matrix",), ("matrix", "*"), ("matrix", "*", "*")}


def fresh(arguments, accepted=(0,)):
    with tempfile.TemporaryDirectory() as folder:
        file = pathlib.Path(folder) / "result.json"
        command = [TETRACE, *arguments, "--out", str(file)]
        environment = {"PATH": "/usr/bin:/bin", "HOME": folder, **{key: os.environ[key] for key in KEPT if key in os.environ}}
        ended = subprocess.run(command, capture_output=True, text=True, env=environment)
        if ended.returncode not in accepted:
            raise AssertionError(f"{command} ended with {ended.returncode}: {ended.stderr}")
        return json.loads(file.read_text())


def tiny(verb, *more):
    return fresh([verb, "--scene", "cubes", "--resolution", "3", "--size", "8", "--backend", "openmp,embree,cuda", *more])


def judged(folder):
    """A check of two repetitions with an unexpected pass, and a comparison of it with another."""
    known, result = folder / "known.json", folder / "check.json"
    known.write_text(json.dumps({"openmp": {"exceptions": {"cdt/maria/tet80": "wrong"}}}))
    check = ["check", "--scene", "cubes", "--resolution", "3", "--size", "8", "--backend", "openmp,embree", "--repeat", "2"]
    expected = fresh([*check, "--expect", str(known)], (1,))
    result.write_text(json.dumps(expected))
    return {"expected": expected, "checks": fresh(["compare", str(result), str(result)])}


def judged_answers(folder):
    """Answers of another program, all of which are misses."""
    rays, hits = folder / "rays.npy", folder / "hits.npy"
    subprocess.run([TETRACE, "rays", "--scene", "cubes", "--count", "9", "--out", str(rays), "--answers", str(hits)], check=True,
                   stdout=subprocess.DEVNULL)
    bytes_ = hits.read_bytes()
    hits.write_bytes(bytes_[:-27 * 16] + b"".join([b"\0\0\x80\xbf" + bytes(12)] * 27))
    return fresh(["judge", "--mesh", "cubes", "--ray-file", str(rays), "--hits", str(hits)], (1,))


def reproduced(bench):
    """A result of `tetrace reproduce`, as results/README.md states it."""
    head = ("schema_version", "date", "version", "commit", "compiler", "flags", "host")
    section = {key: bench["tetrace"][key] for key in head}
    scene = {**bench["tetrace"]["scenes"][0],
             "start_walk": {"walked": 3, "located": 1, "steps": 20, "most_steps": 9, "exact_s": 0.01},
             "likeness": {"kind": "other mesh", "compared": False, "reason": "another mesh"}}
    return {"tetrace": {**section, "verb": "reproduce", "scenes": [scene], "tables": [TABLE], "figures": [FIGURE]}}


def places(value, path=()):
    """Every object and every scalar below a value, with its path."""
    if isinstance(value, dict):
        yield path, value
        for key, part in value.items():
            yield from places(part, path + (key,))
    elif isinstance(value, list):
        for index, part in enumerate(value):
            yield from places(part, path + (index,))
    else:
        yield path, value


def kind_of(value, path):
    """The path without list indices, and the status of each row on it: places of one kind are judged by one part of the schema."""
    kind = []
    for step in path:
        value = value[step]
        kind.append(value.get("status", "") if isinstance(step, int) and isinstance(value, dict) else "*" if isinstance(step, int) else step)
    return tuple(kind), type(value).__name__


def kinds(result):
    """places(result), the first of each kind; of an object's kind are its keys, too."""
    seen = set()
    for path, value in places(result):
        kind = kind_of(result, path), frozenset(value) if isinstance(value, dict) else None
        if kind not in seen:
            seen.add(kind)
            yield path, value


def is_row_of_a_table(path):
    return len(path) == 4 and path[0] == "tables" and path[2] == "rows"


def is_free(path):
    return path in FREE_KEYS or is_row_of_a_table(path) or (path[:1] == ("matrix",) and ("matrix",) + ("*",) * (len(path) - 1) in FREE_KEYS)


def twin(result, path, change):
    """A copy of the result in which change(parent, key) was done at the path below `tetrace`."""
    copied = copy.deepcopy(result)
    parent = copied["tetrace"]
    for step in path[:-1]:
        parent = parent[step]
    change(parent, path[-1])
    return copied


def rename(parent, key):
    parent[key + "s"] = parent.pop(key)


def change_type(parent, key):
    parent[key] = 5 if isinstance(parent[key], (str, bool)) else "5"


class ResultSchema(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.bench = tiny("bench", "--samples", "3", "--sample-time", "0")
        cls.check = tiny("check")
        with tempfile.NamedTemporaryFile("w", suffix=".json") as file:
            json.dump(cls.bench, file)
            file.flush()
            cls.compare = fresh(["compare", file.name, file.name])
            several = fresh(["compare", file.name, file.name, file.name])
        with tempfile.TemporaryDirectory() as folder:
            checks = judged(pathlib.Path(folder))
            checks["judge"] = judged_answers(pathlib.Path(folder))
        cls.all = {**checks, "bench": cls.bench, "check": cls.check, "compare": cls.compare, "several": several, "reproduce": reproduced(cls.bench),
                   "table5": fresh(["reproduce", "table5", "--searches", "20x8", "--samples", "3", "--sample-time", "0", "--method", "maria",
                                    "--layout", "tet80", "--backend", "openmp", "--threads", "1"]),
                   # Without OpenCL, whose drivers take long to compile these: its entries have the same form.
                   "defects": fresh(["check", "--defects", "--stress", "--backend", "openmp,vulkan,cuda,cuda-host"], (0, 1)),
                   "variants": fresh(["check", "--variants", "1", "--scene", "cubes", "--resolution", "3", "--size", "8", "--method", "maria", "--layout", "tet80",
                                     "--backend", "vulkan"], (0, 3)),
                   "trace": fresh(["trace", "--scene", "cubes", "--resolution", "3", "--size", "8", "--pixel", "4,4", "--backend", "openmp,cuda-host"]),
                   "ray": fresh(["trace", "--scene", "cubes", "--resolution", "3", "--size", "8", "--pixel", "4,4", "--backend", "openmp",
                                 "--rays", "ao", "--ray-order", "morton"]),
                   "visits": fresh(["trace", "--scene", "cubes", "--resolution", "3", "--size", "8", "--pixel", "4,4", "--backend", "openmp",
                                    "--layout", "bvh2"]),
                   "inspect": fresh(["inspect", "--target", "gfx1100", "--method", "maria", "--layout", "tet80"], (0, 3))}

    def accepts(self, result, name):
        errors = [f"{'.'.join(map(str, e.absolute_path))}: {e.message[:300]}" for e in VALIDATOR.iter_errors(result)]
        self.assertEqual(errors, [], name)

    def refuses(self, result, name):
        self.assertFalse(VALIDATOR.is_valid(result), f"accepted: {name}")

    def test_schema_is_one(self):
        jsonschema.Draft202012Validator.check_schema(SCHEMA)

    def test_results_of_the_repository_are_valid(self):
        files = [file for file in RESULTS.rglob("*.json") if not file.name.endswith(".schema.json")]
        self.assertTrue(files)
        for file in files:
            self.accepts(json.loads(file.read_text()), str(file))

    def test_fresh_results_are_valid(self):
        for verb, result in self.all.items():
            self.accepts(result, verb)
        self.assertTrue(any("samples_s" in row.get("times", {}) for row in self.bench["tetrace"]["rows"]))

    def test_own_cameras_are_what_their_schema_says(self):
        docs = RESULTS.parent / "docs"
        schema = jsonschema.Draft202012Validator(json.loads((docs / "cameras.schema.json").read_text()))
        example = json.loads((docs / "cameras.example.json").read_text())
        self.assertTrue(schema.is_valid(example))
        self.assertIn(json.dumps(example["views"][1]), (docs / "cameras.md").read_text().replace("{ ", "{").replace(" }", "}"))
        for wrong in ({**example, "name": "orbit"}, {**example, "views": []}, {**example, "views": [{"target": [0, 0, 0]}]}):
            self.assertFalse(schema.is_valid(wrong))
        self.accepts(tiny("bench", "--samples", "3", "--sample-time", "0", "--camera-set", str(docs / "cameras.example.json")), "own cameras")

    def test_anonymous_results_are_valid(self):
        self.accepts(tiny("bench", "--samples", "3", "--sample-time", "0", "--anonymous"), "bench")

    def test_a_renamed_key_is_refused(self):
        for verb, result in self.all.items():
            for path, value in kinds(result["tetrace"]):
                if isinstance(value, dict) and not is_free(path):
                    for key in value:
                        self.refuses(twin(result, path + (key,), rename), f"{verb}: {path} {key}")

    def test_a_value_of_another_type_is_refused(self):
        for verb, result in self.all.items():
            for path, value in kinds(result["tetrace"]):
                if not isinstance(value, dict) and not is_free(path[:-1]):
                    self.refuses(twin(result, path, change_type), f"{verb}: {path}")

    def test_values_that_cannot_be_are_refused(self):
        def put(*path_and_value):
            *path, value = path_and_value
            return twin(self.all[path[0]], tuple(path[1:]), lambda parent, key: parent.__setitem__(key, value))

        for bad in (
            ("bench", "schema_version", 3),
            ("bench", "verb", "benchmark"),
            ("bench", "date", "today"),
            ("bench", "rows", 0, "status", "fine"),
            ("bench", "rows", 0, "status", "wrong"),
            ("bench", "rows", 0, "hit_hash", "00000000000000FF"),
            ("bench", "rows", 0, "times", "samples_s", 0, 0),
            ("bench", "rows", 0, "times", "samples_s", []),
            ("bench", "rows", 0, "counts", "hits", -1),
            ("bench", "rows", 0, "counts", "hits", 1.5),
            ("bench", "copy_bytes_per_s", 1e9),
            ("bench", "scenes", 0, "file", "/home/somebody/cubes.tet"),
            ("reproduce", "tables", 0, "claims", 0, "verdict", "perhaps"),
            ("reproduce", "scenes", 0, "likeness", "kind", "not its scene"),
            ("reproduce", "scenes", 0, "start_walk", "steps", -1),
            ("reproduce", "tables", 0, "rows", 0, "lost", True),
            ("reproduce", "tables", 0, "rows", 0, "lost", "value", "none"),
            ("reproduce", "figures", 0, "series", 0, "points", 0, [1, 2, 3]),
            ("reproduce", "figures", 0, "pictures", 0, "/tmp/picture.png"),
            ("table5", "searches", "rows", 0, "msearches_per_s", 0),
            ("table5", "searches", "rows", 0, "status", "wrong"),
            ("table5", "searches", "rows", 0, "batch_medians_s", []),
            ("table5", "searches", "rows", 0, "verification", "wrong", -1),
            ("compare", "comparison", "rows", 0, "verdict", "same"),
            ("inspect", "programs", 0, "status", "fine"),
            ("inspect", "programs", 0, "target", "/dev/null"),
            ("inspect", "programs", 0, "registers", -1),
            ("defects", "defects", 0, "outcome", "perhaps"),
            ("trace", "trace", "pixel", [1]),
            ("trace", "trace", "devices", 0, "steps", 0, "face", 4),
            ("trace", "trace", "devices", 0, "status", "fine"),
            ("ray", "trace", "rays", "primary"),
            ("ray", "trace", "start", "face", 4),
            ("visits", "trace", "devices", 0, "visits", "nodes", -1),
        ):
            self.refuses(put(*bad), str(bad))

    def test_a_result_without_what_its_verb_promises_is_refused(self):
        for verb, keys in {
            "bench": ("rows", "devices", "ratios", "scenes", "host", "commit"),
            "check": ("rows", "matrix", "missing_devices"),
            "compare": ("comparison",),
            "inspect": ("programs", "skipped_targets"),
            "defects": ("defects", "missing_devices"),
            "trace": ("scenes", "trace"),
            "judge": ("judged",),
        }.items():
            for key in keys:
                self.refuses(twin(self.all[verb], (key,), lambda parent, name: parent.pop(name)), f"{verb}: no {key}")
        self.refuses({}, "nothing")
        self.refuses({**self.bench, "more": 1}, "a key next to tetrace")


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=2)
