"""rays, inside, check, dump: answers on standard output, in the shapes of the manual."""

import json
import math
import re
import subprocess

from command_line import CommandLine, main


class Answers(CommandLine):
    def test_rays_json_has_the_shape_of_the_manual(self):
        done = self.run_raymo("rays", "cup.raymo", "--json", stdin="-100 0 30 1 0 0\n-100 0 1 2 0 0\n0 0 900 1 0 0\n")
        lines = [json.loads(line) for line in done.stdout.splitlines()]
        self.assertEqual(len(lines), 3)
        walls = lines[0]["spans"]
        self.assertEqual(len(walls), 2)
        for span, (t0, t1) in zip(walls, ((80, 82), (118, 120))):
            self.assertEqual(set(span), {"enter", "exit"})
            for end, t in ((span["enter"], t0), (span["exit"], t1)):
                self.assertEqual(set(end), {"t", "point", "normal", "part", "material", "leaf", "face"})
                self.assertAlmostEqual(end["t"], t, delta=1e-12 * 100)
                self.assertAlmostEqual(end["point"][0], t - 100, delta=1e-12 * 100)
                self.assertEqual(end["point"][1:], [0, 30])
                self.assertAlmostEqual(math.hypot(*end["normal"]), 1, delta=1e-15)
                self.assertEqual((end["part"], end["material"], end["face"]), ("cup", "tomato", "side"))
        self.assertEqual(walls[0]["enter"]["leaf"], "cylinder@cup.raymo:2:12")
        self.assertEqual(walls[0]["exit"]["leaf"], "cylinder@cup.raymo:2:35")
        self.assertEqual([round(s[e]["normal"][0]) for s in walls for e in ("enter", "exit")], [-1, 1, -1, 1])
        # A direction of length two halves t; the base is one span from wall to wall.
        base = lines[1]["spans"]
        self.assertEqual(len(base), 1)
        self.assertAlmostEqual(base[0]["enter"]["t"], 40, delta=1e-10)
        self.assertAlmostEqual(base[0]["exit"]["t"], 60, delta=1e-10)
        self.assertEqual(lines[2], {"spans": []})

    def test_rays_see_the_whole_line_or_what_is_ahead(self):
        ray = "0 0 1  1 0 0"
        whole = json.loads(self.run_raymo("rays", "cup.raymo", "--json", "--part", "cup", stdin=ray).stdout)
        self.assertAlmostEqual(whole["spans"][0]["enter"]["t"], -20, delta=1e-12)
        ahead = json.loads(self.run_raymo("rays", "cup.raymo", "--json", "--from-origin", stdin=ray).stdout)
        first = ahead["spans"][0]["enter"]
        self.assertEqual(first, {"t": 0, "point": [0, 0, 1], "normal": None, "part": "cup", "material": None,
                                 "leaf": None, "face": None})
        self.assertAlmostEqual(ahead["spans"][0]["exit"]["t"], 20, delta=1e-12)

    def test_rays_of_one_part(self):
        both = json.loads(self.run_raymo("rays", "cup.raymo", "--json", stdin="-99 0 10 1 0 0").stdout)["spans"]
        self.assertEqual([s["enter"]["part"] for s in both], ["cup", "cup", "ball"])
        self.assertEqual(both[2]["enter"]["material"], "default")
        ball = json.loads(
            self.run_raymo("rays", "cup.raymo", "--json", "--part", "ball", stdin="-99 0 10 1 0 0").stdout)["spans"]
        self.assertEqual(ball, both[2:])

    def test_numbers_read_back(self):
        done = self.run_raymo("rays", "cup.raymo", "--json", stdin="-100 3.3 10.1 1 0.01 0.002")
        found = re.findall(r'(?<=[:,\[])-?[0-9][-+.e0-9]*(?=[,\]}])', done.stdout)
        self.assertGreaterEqual(len(found), 14)
        for text in found:
            # The shortest digits that read back: none that Python, which prints those too, would leave out.
            digits = [c for c in text.split("e")[0] if c.isdigit()]
            shortest = [c for c in repr(float(text)).split("e")[0] if c.isdigit()]
            self.assertLessEqual(len("".join(digits).strip("0")), len("".join(shortest).strip("0")))

    def test_text_answers_are_one_line_each(self):
        done = self.run_raymo("rays", "cup.raymo", stdin="# probes\n-100 0 1 1 0 0\n\n0,0,900,1,0,0\n")
        lines = done.stdout.splitlines()
        self.assertEqual(len(lines), 2)
        self.assertIn("cylinder@cup.raymo:2:12 side", lines[0])
        self.assertEqual(lines[1], "nothing")

    def test_inside(self):
        points = "0 0 0\n19 0 30\n0 0 30\n20 0 30\n20 0 60\n50 0 10\n55 0 10\n1e300 0 0\n"
        expected = ["on", "in", "out", "on", "on", "in", "on", "out"]
        self.assertEqual(self.run_raymo("inside", "cup.raymo", stdin=points).stdout.split(), expected)
        out = self.run_raymo("inside", "cup.raymo", "--json", stdin=points).stdout
        self.assertEqual([json.loads(line) for line in out.splitlines()], [{"where": w} for w in expected])
        self.assertEqual(self.run_raymo("inside", "cup.raymo", "--part", "ball", stdin="19 0 30\n50 0 10").stdout,
                         "out\nin\n")

    def test_inside_is_regularised(self):
        self.write("two.raymo", "part a = block(1, 1, 1) + block(1, 1, 1).move(x: 1)\n"
                                "part none = sphere(3) - sphere(3)\n")
        self.assertEqual(self.run_raymo("inside", "two.raymo", stdin="1 .5 .5\n1 0 .5\n2 .5 .5\n3 0 0").stdout.split(),
                         ["in", "on", "on", "out"])

    def test_lines_that_are_wrong_name_their_number(self):
        cases = [("rays", "0 0 0 1 0 0\n1 2 3\n", ":2:", "3 numbers"), ("rays", "0 0 0 0 0 0", ":1:", "zero"),
                 ("rays", "\n\n1 2 3 4 5 six", ":3:", '"six"'), ("inside", "1 2 3 4", ":1:", "4 numbers"),
                 ("inside", "1 2 nan", ":1:", '"nan"'), ("inside", "1 2 1e999", ":1:", '"1e999"'),
                 ("inside", b"\xff\x00\x01", ":1:", "not a finite number"), ("inside", "7" * 3_000_000, "", "1 MiB")]
        for command, text, place, what in cases:
            done = self.run_raymo(command, "cup.raymo", stdin=text, code=2)
            self.assertIn(place, done.stderr)
            self.assertIn(what, done.stderr)
        # What came before the wrong line has been answered.
        done = self.run_raymo("inside", "cup.raymo", stdin="0 0 0\nx\n", code=2)
        self.assertEqual(done.stdout, "on\n")

    def test_no_input_no_answers(self):
        self.assertEqual(self.run_raymo("rays", "cup.raymo", stdin="").stdout, "")
        self.assertEqual(self.run_raymo("inside", "cup.raymo", stdin="").stdout, "")
        self.run_raymo("rays", "-", stdin=b"", code=2)

    def test_an_answer_comes_before_the_next_question(self):
        process = self.start("inside", "cup.raymo", stdin=subprocess.PIPE, stdout=subprocess.PIPE)
        for question, answer in ((b"0 0 0\n", b"on\n"), (b"19 0 30\n", b"in\n")):
            process.stdin.write(question)
            process.stdin.flush()
            self.assertEqual(process.stdout.readline(), answer)
        process.communicate()
        self.assertEqual(process.returncode, 0)

    def test_check_prints_nothing_but_what_is_wrong(self):
        done = self.run_raymo("check", "cup.raymo")
        self.assertEqual((done.stdout, done.stderr), ("", ""))
        self.write("warn.raymo", "1 + 2\npart a = sphere(1)\n")
        done = self.run_raymo("check", "warn.raymo")
        self.assertEqual(done.stdout, "")
        self.assertIn("warn.raymo:1:1", done.stderr)
        self.write("wrong.raymo", "part a = spere(3)\npart b = sphere(-1)\n")
        done = self.run_raymo("check", "wrong.raymo", code=1)
        self.assertIn("wrong.raymo:1:10", done.stderr)
        self.assertEqual(done.stdout, "")

    def test_questions_in_the_language_are_answered(self):
        self.write("ask.raymo", """\
let s = sphere(10)
let h = hits(s, (-20, 0, 0), (1, 0, 0))
assert len(h) == 1 and abs(h[0].enter - 10) < 1e-9, "${h}"
assert contains(s, (10, 0, 0)) and contains(s, (0, 0, 0)) and not contains(s, (10.001, 0, 0))
assert is_empty(s - s) and not is_empty(s) and is_empty(block(1, 1, 1) & block(1, 1, 1).move(x: 1))
part p = s
""")
        done = self.run_raymo("check", "ask.raymo")
        self.assertEqual(done.stderr, "")

    def test_dump(self):
        self.assertIn("param", self.run_raymo("dump", "cup.raymo", "--stage", "tokens").stdout)
        self.assertIn("cylinder", self.run_raymo("dump", "cup.raymo", "--stage", "ast").stdout)
        model = self.run_raymo("dump", "cup.raymo", "--stage", "model").stdout
        self.assertIn("difference", model)
        self.assertIn('part "ball" #', model)
        self.assertIn("leaves 3\n", self.run_raymo("dump", "cup.raymo", "--stage", "compiled").stdout)
        self.run_raymo("dump", "cup.raymo", code=2)
        self.run_raymo("dump", "cup.raymo", "--stage", "soup", code=2)

    def test_dump_writes_a_shared_solid_once(self):
        self.write("shared.raymo", "var s = sphere(1)\nfor i in 0..<40 { s = s + s.move(x: 2 ^ i) }\npart p = s\n")
        out = self.run_raymo("dump", "shared.raymo", "--stage", "model").stdout
        self.assertLess(len(out.splitlines()), 100)


if __name__ == "__main__":
    main()
