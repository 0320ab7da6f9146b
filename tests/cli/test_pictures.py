"""Pictures on disk and on standard output."""

import json
import os
import stat
import subprocess

from command_line import CUP, CommandLine, main, png_size


class Pictures(CommandLine):
    def test_render_writes_the_size_asked_for(self):
        self.run_raymo("render", "cup.raymo", "-o", "cup.png", "--size", "64x48")
        self.assertEqual(png_size((self.folder / "cup.png").read_bytes()), (64, 48))
        self.assertEqual(self.files(), ["cup.png", "cup.raymo"])
        plain = self.write("plain", "")
        self.assertEqual((self.folder / "cup.png").stat().st_mode, plain.stat().st_mode)

    def test_the_short_form_is_the_same(self):
        self.run_raymo("render", "cup.raymo", "-o", "a.png", "--size", "40x30")
        self.run_raymo("cup.raymo", "-o", "b.png", "--size", "40x30")
        self.run_raymo("--size", "40x30", "-o", "c.png", "cup.raymo")
        a = (self.folder / "a.png").read_bytes()
        self.assertEqual(a, (self.folder / "b.png").read_bytes())
        self.assertEqual(a, (self.folder / "c.png").read_bytes())

    def test_without_an_output_the_model_gives_the_name(self):
        self.write("models/jug.raymo", CUP)
        done = self.run_raymo("render", "models/jug.raymo", "--size", "8x8")
        self.assertIn("jug.png", done.stderr)
        self.assertTrue((self.folder / "jug.png").exists())
        done = self.run_raymo("render", "models/jug.raymo", "--size", "8x8", "--quiet")
        self.assertEqual(done.stderr, "")

    def test_several_outputs_and_standard_output(self):
        done = self.run_raymo("cup.raymo", "-o", "a.png", "-o", "-", "-o", "b.png", "--size", "20x10")
        self.assertEqual(png_size(done.raw), (20, 10))
        for name in ("a.png", "b.png"):
            self.assertEqual((self.folder / name).read_bytes(), done.raw)

    def test_a_model_on_standard_input(self):
        done = self.run_raymo("render", "-", "-o", "-", "--size", "16x16", stdin=CUP)
        self.assertEqual(png_size(done.raw), (16, 16))
        self.assertIn("-o", self.run_raymo("render", "-", stdin=CUP, code=2).stderr)
        self.assertIn("<stdin>:1:10", self.run_raymo("check", "-", stdin="part a = spere(3)", code=1).stderr)

    def test_one_picture_whatever_the_threads(self):
        pictures = [self.run_raymo("cup.raymo", "-o", "-", "--size", "90x70", "--threads", n).raw
                    for n in (1, 2, 3, 7)]
        self.assertEqual(len(set(pictures)), 1)

    def test_cameras_change_the_picture(self):
        def draw(*arguments):
            return self.run_raymo("cup.raymo", "-o", "-", "--size", "40x30", *arguments).raw

        pictures = [draw(), draw("--view", "above"), draw("--az", "10"), draw("--fit"), draw("--angle", "40"),
                    draw("--eye", "-300,0,10"), draw("--projection", "parallel"), draw("--el", "90"),
                    draw("--look-at", "0,0,0"), draw("--up", "1,0,0")]
        self.assertEqual(len(set(pictures)), len(pictures))
        self.assertEqual(draw(), draw("--view", "front"))
        self.run_raymo("cup.raymo", "-o", "-", "--eye", "0,0,30", code=2)
        self.run_raymo("cup.raymo", "-o", "-", "--up", "0,300,-50", code=2)

    def test_every_quality(self):
        for quality in ("draft", "preview", "final"):
            self.run_raymo("cup.raymo", "-o", "q.png", "--size", "33x17", "--quality", quality)
            self.assertEqual(png_size((self.folder / "q.png").read_bytes()), (33, 17))

    def test_stats(self):
        done = self.run_raymo("cup.raymo", "-o", "s.png", "--size", "32x32", "--stats", "json")
        stats = json.loads(done.stderr)
        self.assertGreaterEqual(stats["rays"]["primary"], 32 * 32)
        self.assertEqual(set(stats["rays"]), {"primary", "shadow", "secondary"})
        self.assertEqual(set(stats["seconds"]), {"parse", "evaluate", "compile", "trace", "write"})
        self.assertTrue(all(s >= 0 for s in stats["seconds"].values()))
        self.assertGreater(stats["seconds"]["trace"], 0)
        self.assertEqual(stats["leaves"], 3)
        self.assertGreater(stats["peak_memory"], 1e6)
        self.assertIn("primary", self.run_raymo("cup.raymo", "-o", "s.png", "--size", "8x8", "--stats").stderr)

    def test_a_link_and_a_device_are_written_to_not_replaced(self):
        self.write("real.png", "old")
        os.symlink("real.png", self.folder / "link.png")
        self.run_raymo("cup.raymo", "-o", "link.png", "--size", "8x8")
        self.assertTrue((self.folder / "link.png").is_symlink())
        self.assertEqual(png_size((self.folder / "real.png").read_bytes()), (8, 8))
        self.run_raymo("cup.raymo", "-o", "/dev/null", "--size", "8x8")
        self.assertTrue(stat.S_ISCHR(os.stat("/dev/null").st_mode))

    def test_a_pipe_that_closes(self):
        process = self.start("cup.raymo", "-o", "-", "--size", "900x900", "--quality", "draft",
                             stdout=subprocess.PIPE, stderr=subprocess.PIPE)
        process.stdout.read(8)
        process.stdout.close()
        error = process.stderr.read()
        process.stderr.close()
        self.assertIn(process.wait(), (0, 3))
        self.assertEqual(error, b"")

    def test_imports_come_from_the_models_folder_only(self):
        self.write("gear.raymo", "fn gear(r) = sphere(r)\n")
        self.write("lib/tooth.raymo", 'from "../gear.raymo" import gear\nfn tooth() = gear(1)\n')
        self.write("main.raymo", 'from "lib/tooth.raymo" import tooth\npart p = tooth()\n')
        self.run_raymo("check", "main.raymo")
        self.run_raymo("check", self.folder / "main.raymo")
        self.write("lib/out.raymo", 'import "../gear.raymo" as g\npart p = g.gear(1)\n')
        self.assertIn("outside", self.run_raymo("check", "lib/out.raymo", code=1).stderr)
        os.symlink("/etc/passwd", self.folder / "passwd.raymo")
        self.write("link.raymo", 'import "passwd.raymo" as g\npart p = sphere(1)\n')
        self.assertIn("outside", self.run_raymo("check", "link.raymo", code=1).stderr)
        self.write("folder.raymo", 'import "." as g\npart p = sphere(1)\n')
        self.assertIn("is a folder", self.run_raymo("check", "folder.raymo", code=1).stderr)
        self.write("folder.raymo", 'import "lib" as g\npart p = sphere(1)\n')
        self.assertIn('name a file in it: "lib/..."', self.run_raymo("check", "folder.raymo", code=1).stderr)
        self.write("folder.raymo", 'prism(svg("lib"), 1)\n')
        self.assertIn('name a file in it: "lib/..."', self.run_raymo("check", "folder.raymo", code=1).stderr)
        self.write("folder.raymo", 'import ".." as g\npart p = sphere(1)\n')
        self.assertIn("outside", self.run_raymo("check", "folder.raymo", code=1).stderr)
        self.write("none.raymo", 'import "nowhere.raymo" as g\npart p = sphere(1)\n')
        self.assertIn("none.raymo:1:", self.run_raymo("check", "none.raymo", code=1).stderr)


if __name__ == "__main__":
    main()
