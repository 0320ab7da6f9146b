"""What the program understands of its command line, and how it refuses the rest."""

from command_line import CommandLine, main


class Arguments(CommandLine):
    def test_help_of_the_program_and_of_every_command(self):
        for arguments in (["--help"], ["-h"], ["help"]):
            out = self.run_raymo(*arguments).stdout
            self.assertIn("Examples:", out)
            self.assertIn("Exit codes:", out)
        for command in ("render", "check", "rays", "inside", "dump"):
            for arguments in ([command, "--help"], ["help", command]):
                out = self.run_raymo(*arguments).stdout
                self.assertIn("Examples:", out)
                self.assertIn(f"raymo {command}", out)
                self.assertIn("--memory-limit", out)

    def test_version(self):
        self.assertRegex(self.run_raymo("--version").stdout, r"^raymo \d+\.\d+\.\d+\n$")

    def test_nothing_asked(self):
        self.assertIn("Usage:", self.run_raymo(code=2).stderr)

    def test_commands_to_come_say_so(self):
        for command in ("measure", "mesh", "voxels", "section", "drawing", "fmt", "animate", "shell", "repl",
                        "studio", "lsp", "bench", "completion"):
            self.assertIn("not available yet", self.run_raymo(command, "cup.raymo", code=2).stderr)
        self.assertIn("not available yet", self.run_raymo("check", "cup.raymo", "--clash", code=2).stderr)
        self.assertIn("not available yet",
                      self.run_raymo("dump", "cup.raymo", "--stage", "commands", code=2).stderr)

    def test_outputs_to_come_say_so(self):
        for suffix in ("exr", "stl", "3mf", "obj", "ply", "glb", "vdb", "npy", "raw", "svg", "dxf", "mp4"):
            for command in (["render", "cup.raymo"], ["cup.raymo"]):
                done = self.run_raymo(*command, "-o", f"out.{suffix}", code=2)
                self.assertIn("not available yet", done.stderr)
        self.assertEqual(self.files(), ["cup.raymo"])

    def test_unknown_words_get_suggestions(self):
        self.assertIn("did you mean `render`?", self.run_raymo("rendr", "cup.raymo", code=2).stderr)
        done = self.run_raymo("render", "cup.raymo", "--qualtiy", "draft", code=2)
        self.assertIn("did you mean `--quality`?", done.stderr)
        done = self.run_raymo("render", "cup.raymo", "--view", "frnot", "-o", "a.png", code=2)
        self.assertIn("did you mean `front`?", done.stderr)
        done = self.run_raymo("inside", "cup.raymo", "--part", "cupp", code=2)
        self.assertIn("did you mean `cup`?", done.stderr)
        done = self.run_raymo("check", "cup.raymo", "-D", "heigth=20", code=2)
        self.assertIn("did you mean `height`?", done.stderr)

    def test_values_that_are_missing_or_wrong(self):
        for arguments in (["-o"], ["--size"], ["--size", "0x10"], ["--size", "10x0"], ["--size", "1e3x2"],
                          ["--size", "99999x99999"], ["--angle", "181"], ["--eye", "1,2"], ["--samples", "0"],
                          ["--threads", "none"], ["--quality", "best"], ["-D", "height"], ["--stats=yaml"],
                          ["--time-limit", "-3"], ["--memory-limit", "0"], ["-o", "picture"],
                          ["-o", "picture.gif"], ["-o", "a.png", "-o", "a.png"], ["second.raymo"]):
            done = self.run_raymo("render", "cup.raymo", *arguments, code=2)
            self.assertRegex(done.stderr, r"^error: ")
        self.assertEqual(self.files(), ["cup.raymo"])

    def test_a_parameter_out_of_its_range_is_the_command_lines_fault(self):
        done = self.run_raymo("check", "cup.raymo", "-D", "height=5", code=2)
        self.assertIn("10 to 200", done.stderr)
        done = self.run_raymo("check", "cup.raymo", "-D", "height=20 +", code=2)
        self.assertIn("-D height", done.stderr)

    def test_parameters_from_a_file(self):
        self.write("p.json", '{"height": 100}')
        probe = "0 0 1000  0 0 -1\n"
        model = ["rays", "cup.raymo", "--part", "cup"]
        out = self.run_raymo(*model, "--params", "p.json", stdin="19 0 1000 0 0 -1").stdout
        self.assertTrue(out.startswith("900 .. 1000"), out)
        out = self.run_raymo(*model, "--params", "p.json", "-D", "height=50", stdin="19 0 1000 0 0 -1").stdout
        self.assertTrue(out.startswith("950 .. 1000"), out)
        self.assertTrue(self.run_raymo(*model, stdin=probe).stdout.startswith("998 .. 1000"))
        self.run_raymo("check", "cup.raymo", "--params", "none.json", code=3)
        for text in ("", "[]", '{"height": ', '{"width": 3}', '{"height": "x"}', "[" * 100_000):
            self.write("p.json", text)
            self.run_raymo("check", "cup.raymo", "--params", "p.json", code=2)

    def test_options_may_stand_before_the_command(self):
        for options in (["--color=never"], ["--color", "always"], ["--quiet"], ["--stats"], ["--stats", "json"],
                        ["-D", "height=20", "--threads", "1"]):
            after = self.run_raymo("check", *options, "cup.raymo")
            before = self.run_raymo(*options, "check", "cup.raymo")
            self.assertEqual(before.stdout, after.stdout)
        self.write("bad.raymo", "part a = spere(3)\n")
        self.assertIn("\033[", self.run_raymo("--color=always", "check", "bad.raymo", code=1).stderr)
        done = self.run_raymo("--color", "always", "measure", "cup.raymo", code=2)
        self.assertIn("not available yet", done.stderr)
        # A value is no command, and a file called like one is given as ./check.
        self.assertIn("no FILE", self.run_raymo("--view", "check", code=2).stderr)
        self.run_raymo("--size", "8x8", "cup.raymo", "-o", "a.png")
        self.assertEqual(self.files(), ["a.png", "bad.raymo", "cup.raymo"])

    def test_color_only_when_asked_for(self):
        self.write("bad.raymo", "part a = spere(3)\n")
        plain = self.run_raymo("check", "bad.raymo", code=1).stderr
        self.assertNotIn("\033", plain)
        self.assertIn("\033[", self.run_raymo("check", "bad.raymo", "--color", "always", code=1).stderr)
        done = self.run_raymo("check", "bad.raymo", code=1, env=self.environment(NO_COLOR="1"))
        self.assertEqual(done.stderr, plain)


if __name__ == "__main__":
    main()
