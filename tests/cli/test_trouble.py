"""Bad input, full disks, interruptions, limits: an exit code, a message, and nothing left behind."""

import os
import pty
import select
import signal
import subprocess
import sys
import time
import unittest

from command_line import SLOW, CommandLine, main


class Trouble(CommandLine):
    def refused(self, text, code=1, *arguments):
        """Draws a program that must be refused without a picture; what it prints."""
        self.write("model.raymo", text)
        done = self.run_raymo("render", "model.raymo", "-o", "model.png", "--size", "16x16", *arguments, code=code)
        self.assertEqual(self.files(), ["cup.raymo", "model.raymo"])
        self.assertEqual(done.stdout, "")
        return done.stderr

    def test_models_that_are_wrong(self):
        self.assertIn("model.raymo:1:", self.refused("part a = sphere(\n"))
        self.assertIn("model.raymo:2:", self.refused("let r = 3\npart a = sphere(r - 4)\n"))
        self.assertIn("too thin", self.refused('assert 1 > 2, "too thin"\npart a = sphere(1)\n'))
        for size in ("0", "-1", "1e400", "0/0", "1/0"):
            self.assertIn("model.raymo:1:", self.refused(f"part a = sphere({size})\n"))
        self.assertIn("model.raymo:1:", self.refused("part a = sphere(1).scale(1, 0, 1)\n"))

    def test_unbounded_models_name_their_operand(self):
        message = self.refused("part a = sphere(1) + halfspace((0, 0, 1), 0)\n")
        self.assertIn("halfspace", message)
        self.assertIn("model.raymo:1:", message)
        self.run_raymo("rays", "model.raymo", stdin="0 0 0 0 0 1", code=1)
        self.assertEqual(self.run_raymo("inside", "model.raymo", stdin="9 9 -9\n9 9 9").stdout, "in\nout\n")

    def test_empty_models(self):
        for text in ("", "// nothing\n", "let s = sphere(1)\n", "part a = sphere(1) - sphere(1)\n",
                     "let s = sphere(1)\npart a = s - s\n", "part a = block(1, 1, 1) - block(3, 3, 3)\n",
                     "part a = block(1, 1, 1) & block(1, 1, 1).move(x: 1)\n",
                     "part a = sphere(1) & sphere(1).move(x: 2)\n"):
            self.assertIn("empty", self.refused(text, 5))

    def test_texts_that_are_none(self):
        self.assertIn("UTF-8", self.refused(b"part a = sphere(1) // \xff\xfe\n"))
        self.refused(b"part a = \0sphere(1)\n")
        self.refused(b"\0" * 1000)
        self.refused(bytes(range(256)) * 100)
        self.refused("(" * 1_000_000)
        self.refused("part a = " + "-" * 1_000_000 + "1")
        self.assertIn("limit", self.refused("[" * (1 << 26) + "[[") + " limit of a program's text")

    def test_a_text_of_a_gibibyte(self):
        path = self.folder / "huge.raymo"
        with open(path, "wb") as file:
            file.truncate(1 << 30)
        start = time.monotonic()
        self.assertIn("64 MiB", self.run_raymo("check", "huge.raymo", code=1).stderr)
        self.assertLess(time.monotonic() - start, 5)
        with subprocess.Popen([sys.executable, "-c",
                               "import sys\ntry:\n  while True: sys.stdout.write('[' * 65536)\nexcept OSError: pass"],
                              stdout=subprocess.PIPE, stderr=subprocess.DEVNULL) as endless:
            done = subprocess.run(self.command("check", "-"), stdin=endless.stdout, capture_output=True, check=False)
            endless.stdout.close()
            self.assertEqual(done.returncode, 1)
            self.assertIn(b"64 MiB", done.stderr)

    def test_files_that_can_not_be_read(self):
        for name in ("none.raymo", "none/none.raymo", ".", "/root/none/none.raymo"):
            done = self.run_raymo("check", name, code=3)
            self.assertIn("can not read", done.stderr)
        if os.geteuid() != 0:
            os.chmod(self.folder / "cup.raymo", 0)
            self.run_raymo("check", "cup.raymo", code=3)

    def test_outputs_that_can_not_be_written(self):
        (self.folder / "folder.png").mkdir()
        for name in ("folder.png", "none/cup.png", "cup.raymo/cup.png", "/proc/cup.png"):
            done = self.run_raymo("cup.raymo", "-o", name, "--size", "8x8", code=3)
            self.assertIn("can not write", done.stderr)
        # Of several outputs none is written when one can not be.
        self.run_raymo("cup.raymo", "-o", "good.png", "-o", "none/cup.png", "--size", "8x8", code=3)
        self.assertEqual(self.files(), ["cup.raymo", "folder.png"])
        done = self.run_raymo("cup.raymo", "-o", "/dev/full", "--size", "8x8", code=3)
        self.assertIn("No space left", done.stderr)

    def test_a_full_standard_output(self):
        with open("/dev/full", "wb") as full:
            for arguments in (["cup.raymo", "-o", "-", "--size", "8x8"], ["--help"],
                              ["dump", "cup.raymo", "--stage", "ast"]):
                done = subprocess.run(self.command(*arguments), stdout=full, stderr=subprocess.PIPE, cwd=self.folder,
                                      check=False)
                self.assertEqual(done.returncode, 3)
                self.assertIn(b"No space left", done.stderr)

    def test_limits(self):
        self.assertIn("time", self.refused("var i = 0\nwhile true { i += 1 }\n", 1, "--time-limit", "0.3"))
        self.assertIn("1000", self.refused("fn f(n) = f(n + 1)\nlet x = f(0)\n"))
        self.assertIn("50", self.refused("fn f(n) = if n == 0 then 0 else f(n - 1)\nlet x = f(60)\n", 1,
                                         "--call-depth", "50"))
        message = self.refused("part a = union([for i in 0..<1000: sphere(1).move(i, 0, 0)])\n", 1,
                               "--solid-limit", "100")
        self.assertIn("100", message)

    def test_the_time_limit_holds_for_the_whole_run(self):
        self.write("slow.raymo", SLOW)
        start = time.monotonic()
        done = self.run_raymo("slow.raymo", "-o", "slow.png", "--size", "4000x4000", "--time-limit", "0.5", code=1)
        self.assertLess(time.monotonic() - start, 5)
        self.assertIn("time limit of 0.5 s", done.stderr)
        self.assertEqual(self.files(), ["cup.raymo", "slow.raymo"])

    @unittest.skipIf(os.environ.get("RAYMO_SANITIZE"), "a sanitizer's own memory can not be limited")
    def test_memory_runs_out_with_a_message(self):
        greedy = "var l = [1]\nwhile true { l = concat(l, l) }\n"
        self.assertIn("memory", self.refused(greedy, 1, "--memory-limit", "0.2"))
        self.write("big.raymo", "part a = sphere(1)\n")
        done = self.run_raymo("big.raymo", "-o", "big.png", "--size", "16000x8000", "--memory-limit", "0.1", code=1)
        self.assertIn("memory limit of 0.1 GiB", done.stderr)
        self.assertEqual(self.files(), ["big.raymo", "cup.raymo", "model.raymo"])

    def interrupt(self, arguments, after, **options):
        """Sends SIGINT; the exit code and the seconds it took to end."""
        process = self.start(*arguments, stderr=subprocess.PIPE, **options)
        time.sleep(after)
        self.assertIsNone(process.poll(), "it ended before it could be interrupted")
        start = time.monotonic()
        process.send_signal(signal.SIGINT)
        _, error = process.communicate(timeout=20)
        return process.returncode, time.monotonic() - start, error

    def test_interrupting_ends_soon_and_leaves_nothing(self):
        self.write("slow.raymo", SLOW)
        self.write("loop.raymo", "var i = 0\nwhile true { i += 1 }\n")
        drawing = ["slow.raymo", "-o", "slow.png", "--size", "4000x4000", "--samples", "64"]
        for arguments in (drawing, drawing + ["--threads", "1"], ["check", "loop.raymo"]):
            code, seconds, error = self.interrupt(arguments, 0.7)
            self.assertEqual(code, 130, error)
            self.assertLess(seconds, 0.5)  # 0.1 s on a machine that has nothing else to do
            self.assertIn(b"interrupted", error)
        self.assertEqual(self.files(), ["cup.raymo", "loop.raymo", "slow.raymo"])

    def test_interrupting_while_it_waits_for_input(self):
        for arguments in (["inside", "cup.raymo"], ["check", "-"]):
            code, seconds, _ = self.interrupt(arguments, 0.5, stdin=subprocess.PIPE, stdout=subprocess.PIPE)
            self.assertEqual(code, 130)
            self.assertLess(seconds, 0.5)

    def terminal(self):
        """Both ends of a terminal; a root file system without /dev/pts has none."""
        try:
            return pty.openpty()
        except OSError as problem:
            self.skipTest(str(problem))

    def test_a_terminal_sees_a_bar_and_a_pipe_does_not(self):
        self.write("slow.raymo", SLOW)
        arguments = ["slow.raymo", "-o", "slow.png", "--size", "4000x4000", "--samples", "64"]
        master, slave = self.terminal()
        process = self.start(*arguments, stderr=slave)
        os.close(slave)
        seen = b""
        end = time.monotonic() + 20
        while b"left" not in seen and time.monotonic() < end:
            if select.select([master], [], [], 0.5)[0]:
                seen += os.read(master, 4096)
        process.send_signal(signal.SIGINT)
        self.assertEqual(process.wait(20), 130)
        os.close(master)
        self.assertIn(b"%", seen)
        self.assertIn(b"left", seen)
        _, _, error = self.interrupt(arguments, 1.5)
        self.assertEqual(error, b"interrupted\n")

    def test_a_terminal_gets_no_picture(self):
        master, slave = self.terminal()
        process = self.start("cup.raymo", "-o", "-", stdout=slave, stderr=subprocess.PIPE)
        os.close(slave)
        _, error = process.communicate(timeout=20)
        os.close(master)
        self.assertEqual(process.returncode, 2)
        self.assertIn(b"terminal", error)


if __name__ == "__main__":
    main()
