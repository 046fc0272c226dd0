"""The program, started from Python."""

import os
import stat
import sys
import textwrap
from pathlib import Path

import numpy as np
import pytest

import hysteron
from hysteron import _program, _toml

SPEC = {
    "name": "small",
    "realizations": 1,
    "surface": {"magnification": 8, "points_per_shortest_wavelength": 4},
    "cycle": {"max_load": [0.002], "approach_step": 0.1},
}


@pytest.fixture
def said(tmp_path, monkeypatch):
    """A program of a few lines in the place of the true one."""

    def write(body):
        path = tmp_path / "hysteron-said"
        path.write_text(f"#!{sys.executable}\nimport sys\n{textwrap.dedent(body)}")
        path.chmod(path.stat().st_mode | stat.S_IXUSR)
        monkeypatch.setenv("HYSTERON", str(path))

    return write


def test_a_dict_is_run(program, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    run = hysteron.run(SPEC, jobs=1, until="aggregate")
    # The contract of the command line: below the working directory, by the name of the spec.
    assert run.dir == tmp_path / "data" / "runs" / "small"
    assert run.cases.num_rows == 1 and len(run.cycle_ids) == 1
    told = capsys.readouterr()
    assert "cycle: 1/1" in told.err and told.out == ""
    stages = {stage["stage"]: stage["units"] for stage in run.status()["stages"]}
    assert [unit["state"] for unit in stages["cycle"]] == ["done"]
    # The same again, as a text and by its path, finds all of it done.
    text = _toml.dumps(SPEC) + "# too long to be a path\n" * 1000
    assert hysteron.run(text, until="aggregate").dir == run.dir
    (tmp_path / "spec.toml").write_text(text)
    again = hysteron.run("spec.toml", until="aggregate")
    assert again.dir == run.dir and "cycle: 1 task, 1 done before" in capsys.readouterr().err
    other = hysteron.run(Path("spec.toml"), out="other", until="generate")
    assert other.dir == tmp_path / "other" and len(other.surface_ids) == 1 and len(other) == 0


def test_a_bad_spec_fails_with_the_words_of_the_program(program, tmp_path):
    with pytest.raises(hysteron.Failed, match=r"^error: unknown key `surfaces` at the top of the spec") as failed:
        hysteron.run({"name": "x", "surfaces": 1}, out=tmp_path)
    assert failed.value.exit_code == 2 and "keys of a spec: name" in str(failed.value)
    with pytest.raises(hysteron.Failed, match="no such file"):
        hysteron.run(tmp_path / "nothing.toml", out=tmp_path)
    with pytest.raises(hysteron.Failed, match="--until"):
        hysteron.run(SPEC, out=tmp_path, until="dinner")
    (tmp_path / "file").write_text("")
    with pytest.raises(hysteron.Failed, match="^error: cannot") as failed:
        hysteron.run(SPEC, out=tmp_path / "file")
    assert failed.value.exit_code == 1


def test_every_form_of_a_key_reaches_the_program(program, tmp_path):
    sweep = [{"name": "zeta", "surface": {"magnification": np.array([8, 16])}}]
    spec = {**SPEC, "seed": np.int64(3), "sweep": sweep, "realizations": {"until_relative_ci": 0.5, "of": "loss", "min": 2, "max": 2}}
    run = hysteron.run(spec, out=tmp_path / "swept", until="generate")
    assert len(run.surface_ids) == 4


def test_failed_cases_are_a_warning(said, tmp_path):
    (tmp_path / "campaign.toml").write_text("")
    said(f"""
        print('{{"dir": "{tmp_path}", "stages": [{{"failed_count": 0}}, {{"failed_count": 2}}]}}')
        sys.exit(3)
    """)
    with pytest.warns(hysteron.FailedCases, match="^2 cases failed; reasons: .*Change the spec"):
        assert hysteron.run("spec.toml").dir == tmp_path


def test_how_a_run_ends(said, capsys):
    said("""
        print("cycle: 3 units, 0 done before", file=sys.stderr)
        print("interrupted: what was finished is kept", file=sys.stderr)
        sys.exit(130)
    """)
    with pytest.raises(hysteron.Interrupted, match="^interrupted: what was finished is kept$"):
        hysteron.run("spec.toml")
    assert "cycle: 3 units" in capsys.readouterr().err
    said("sys.exit(1)")
    with pytest.raises(hysteron.Failed, match="ended with exit code 1 without a message"):
        hysteron.run("spec.toml")
    said("import os, signal; os.kill(os.getpid(), signal.SIGKILL)")
    with pytest.raises(hysteron.Failed) as failed:
        hysteron.run("spec.toml")
    assert failed.value.exit_code == -9


def test_ctrl_c_is_passed_on_and_waited_for(said, monkeypatch):
    said("""
        import signal, time
        def end(*_):
            print("interrupted: between two files", file=sys.stderr)
            sys.exit(130)
        signal.signal(signal.SIGINT, end)
        print("ready", file=sys.stderr, flush=True)
        time.sleep(60)
    """)

    class Terminal:
        """Presses Ctrl-C when the program is at work."""

        def write(self, text):
            if text == "ready\n":
                raise KeyboardInterrupt

        def flush(self):
            pass

    monkeypatch.setattr(sys, "stderr", Terminal())
    with pytest.raises(hysteron.Interrupted, match="between two files"):
        hysteron.run("spec.toml")


def test_where_the_program_is_looked_for(tmp_path, monkeypatch):
    def made(path):
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text("#!/bin/sh\n")
        path.chmod(0o755)
        return path

    built = made(tmp_path / "clone" / "target" / "release" / "hysteron")
    on_path = made(tmp_path / "bin" / "hysteron")
    named = made(tmp_path / "named")
    within = tmp_path / "clone" / "data" / "deep"
    within.mkdir(parents=True)
    monkeypatch.delenv("HYSTERON", raising=False)
    monkeypatch.setattr(_program.sysconfig, "get_path", lambda _: str(tmp_path / "scripts"))
    monkeypatch.setenv("PATH", str(tmp_path / "empty"))
    monkeypatch.chdir(tmp_path)
    with pytest.raises(FileNotFoundError, match="cannot find the program hysteron: .*\nhelp: run `cargo install --path .`"):
        hysteron.run(SPEC)
    monkeypatch.chdir(within)
    assert _program.find() == built
    monkeypatch.setenv("PATH", str(tmp_path / "bin"))
    assert _program.find() == on_path
    monkeypatch.setenv("HYSTERON", str(named))
    assert _program.find() == named
    monkeypatch.setenv("HYSTERON", str(tmp_path / "nothing"))
    with pytest.raises(FileNotFoundError, match="not an executable file"):
        _program.find()


def test_toml():
    tomllib = pytest.importorskip("tomllib" if sys.version_info >= (3, 11) else "tomli")
    spec = {
        "name": 'quotes " \\ and\nlines\tµ \x7f \x01',
        "seed": np.int64(7),
        "left_out": None,
        "flag": True,
        "length": np.float64(1e-9),
        "list": (1, 2.5, "a"),
        "array": np.array([1e-3, 1e22]),
        "empty": [],
        "table": {"deep": {"deeper": {"x": 1}}, "odd key": 1, "none": {}},
        "sweep": [{"name": "a", "surface": {"hurst": [0.7, 0.8]}}, {"name": "b"}],
        "mixed": [1, {"x": [{"y": 2}]}],
    }
    back = tomllib.loads(_toml.dumps(spec))
    expected = {key: value for key, value in spec.items() if value is not None}
    expected |= {"seed": 7, "list": [1, 2.5, "a"], "array": [1e-3, 1e22]}
    assert back == expected
    with pytest.raises(TypeError, match="cannot write surface.when as TOML: it is of type Path"):
        _toml.dumps({"surface": {"when": type("Path", (), {})()}})
    with pytest.raises(TypeError, match="cannot write the key 1 as TOML"):
        _toml.dumps({1: 2})


def test_a_text_with_an_equals_sign_may_be_a_path(said, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    Path("a=b.toml").write_text("")
    said("print('error: ' + sys.argv[-1], file=sys.stderr); sys.exit(2)")
    with pytest.raises(hysteron.Failed, match="^error: a=b.toml$"):
        hysteron.run("a=b.toml")
    with pytest.raises(hysteron.Failed, match=r"^error: .*spec\.toml$") as failed:
        hysteron.run("name = 'x'")
    # The file is gone again.
    assert not os.path.exists(str(failed.value).removeprefix("error: "))


@pytest.mark.parametrize("body", ["", "print(1)", "print('{}')", "print('hello')"])
def test_another_program_is_named(said, body):
    said(body)
    for call in (lambda: hysteron.run("spec.toml"), lambda: hysteron.take("scan.npy") if body != "print('{}')" else hysteron.run("spec.toml")):
        with pytest.raises(hysteron.Failed, match="hysteron-said is not the program hysteron: .*\nhelp: set HYSTERON"):
            call()


def test_a_file_that_is_no_program(tmp_path, monkeypatch):
    path = tmp_path / "text"
    path.write_bytes(b"\x00\x01no program")
    path.chmod(0o755)
    monkeypatch.setenv("HYSTERON", str(path))
    for call in (hysteron.run, hysteron.take):
        with pytest.raises(OSError, match="cannot start .*text: .*\nhelp: set HYSTERON"):
            call("file")
