#!/usr/bin/env python3
"""Bad input is answered by one readable message with exit status 2, and nothing is written.

usage: messages_test.py DDFEM EXAMPLE.prm
"""
import os
import subprocess
import sys
import tempfile

program, example = os.path.abspath(sys.argv[1]), os.path.abspath(sys.argv[2])

OPEN_B = """dataFileVersion = 4
numFileSegments = 1
minCoordinates = [ -500 -500 -500 ]
maxCoordinates = [ 500 500 500 ]
nodeCount = 2
dataDecompType = 1
dataDecompGeometry = [ 1 1 1 ]
domainDecomposition =
 -500 -500 -500 500 500 500
nodalData =
 0,0 -100 0 1500 1 7
   0,1 0.5773502692 0.5773502692 0.5773502692
       0 0 1
 0,1 100 0 1500 1 7
   0,0 -0.5773502692 -0.5773502692 -0.5773502692
       0 0 1
"""

# A line of Burgers vector 1/2[10-1] of fcc, in units of b.
OTHER_B = OPEN_B.replace("0,1 0.5773502692 0.5773502692 0.5773502692", "0,1 0.7071067812 0.0 -0.7071067812").replace(
    "0,0 -0.5773502692 -0.5773502692 -0.5773502692", "0,0 -0.7071067812 0.0 0.7071067812").replace("0 0 1\n", "0 1 0\n")

# A zirconium crystal with the directions of its axes; the source is to be given.
ZIRCONIUM = """subsection Material
 set Name = zirconium
end
subsection Crystal
 set Direction along x = 2 -1 -1 0
 set Direction along z = 0 0 0 1
end
subsection Microstructure
 set Frank-Read sources = {}
end
"""
IRON = """subsection Material
 set Name = iron
end
subsection Microstructure
 set Frank-Read sources = {}
end
"""

# name, text appended to (or replacing, if it starts with '!') the example, --set arguments, words the message must have
CASES = [
    ("wrong entry name", "subsection Loading\n set Strain rat = 1\nend\n", [],
     ["input.prm:", "Strain rat", "did you mean 'Strain rate'"]),
    ("cross-slip law of another metal", "", ["--set", "Material/Name=nickel", "--set", "Cross-slip/Model=thermally activated"],
     ["Cross-slip/Model", "nickel", "only for copper"]),
    ("cross-slip of bcc crystals in fcc", "", ["--set", "Cross-slip/Model=largest stress"], ["Cross-slip/Model", "bcc", "fcc"]),
    ("half a cross-slip law", "", ["--set", "Cross-slip/Model=thermally activated", "--set", "Cross-slip/Schmid volume=5e-27"],
     ["Cross-slip/Attempt rate", "must be positive"]),
    ("wrong section name", "subsection Loadin\n set Strain rate = 1\nend\n", [],
     ["input.prm:", "Loadin", "did you mean 'Loading'"]),
    ("entry at the wrong place", "set Strain rate = 1\n", [], ["input.prm:", "Strain rate", "section 'Loading'"]),
    ("value out of range", "subsection Domain\n set Element degree = 7\nend\n", [],
     ["input.prm:", "Domain/Element degree = 7", "1", "2"]),
    ("word for a number", "subsection Time stepping\n set Final time = soon\nend\n", [],
     ["input.prm:", "Final time = soon", "a positive number, in s"]),
    ("wrong choice", "set Mode = finit\n", [], ["input.prm:", "Mode = finit", "finite"]),
    ("value on the command line", "", ["--set", "Time stepping/Final time=-1"], ["--set", "Final time = -1"]),
    ("assignment without '='", "", ["--set", "Mode"], ["--set", "Section/Entry=value"]),
    ("missing end", "subsection Loading\n", [], ["input.prm", "'end' is missing"]),
    ("not a statement", "hello\n", [], ["input.prm:", "'hello'", "set NAME = VALUE"]),
    ("missing network file", "subsection Microstructure\n set Network file = nowhere.data\nend\n", [],
     ["input.prm:", "Network file", "nowhere.data"]),
    ("missing mesh file", "subsection Domain\n set Shape = mesh\n set Mesh file = nowhere.msh\nend\n", [],
     ["input.prm:", "Mesh file", "nowhere.msh"]),
    ("source outside the grain",
     "subsection Microstructure\n set Frank-Read sources = 1 1 1 / -1 0 1 / 0 0 2e-6 / 2e-7 / 90\nend\n", [],
     ["Microstructure", "outside the grain", " m "]),
    ("source with b.n != 0",
     "subsection Microstructure\n set Frank-Read sources = 1 1 1 / 1 0 1 / 0 0 5e-7 / 2e-7 / 90\nend\n", [],
     ["input.prm:", "b . n", "[101]", "(111)"]),
    ("segment with b.n != 0 in a network file",
     "subsection Microstructure\n set Frank-Read sources =\n set Network file = open.data\nend\n", [],
     ["open.data:", "b"]),
    ("directions that are not orthogonal", "subsection Crystal\n set Direction along x = 1 1 1\nend\n", [],
     ["input.prm:", "Direction along x", "orthogonal"]),
    ("unknown material", "subsection Material\n set Name = aluminiumm\nend\n", [], ["input.prm:", "aluminium", "copper"]),
    ("hcp directions that are not orthogonal", "subsection Material\n set Name = zirconium\nend\n", [],
     ["input.prm:", "Direction along x", "[01-1-1]", "orthogonal"]),
    ("four indices that do not add up", ZIRCONIUM.format("0 0 0 1 / 1 1 2 0 / 0 0 5e-7 / 2e-7 / 90"), [],
     ["input.prm:", "Frank-Read sources", "112", "add up to zero"]),
    ("four indices in a cubic crystal", IRON.format("0 1 -1 1 / 1 1 1 / 0 0 5e-7 / 2e-7 / 90"), [],
     ["input.prm:", "Frank-Read sources", "three integer Miller indices", "bcc"]),
    ("five indices", ZIRCONIUM.format("0 0 0 0 1 / 1 1 -2 0 / 0 0 5e-7 / 2e-7 / 90"), [],
     ["input.prm:", "Frank-Read sources", "three or four", "hcp"]),
    ("index that is no integer", ZIRCONIUM.format("0 0 0 1.5 / 1 1 -2 0 / 0 0 5e-7 / 2e-7 / 90"), [],
     ["input.prm:", "Frank-Read sources", "integer"]),
    ("slip plane that an <a> does not have", ZIRCONIUM.format("1 -1 0 2 / 1 1 -2 0 / 0 0 5e-7 / 2e-7 / 90"), [],
     ["input.prm:", "(1-102)", "[11-20]", "hcp", "(0001)", "(1-100)", "(1-101)"]),
    ("Burgers vector <c>, which does not glide", ZIRCONIUM.format("1 0 -1 0 / 0 0 0 1 / 0 0 5e-7 / 2e-7 / 90"), [],
     ["input.prm:", "[0001]", "hcp", "1/3<11-20>", "1/3<11-23>"]),
    ("source with b.n != 0 in four indices", ZIRCONIUM.format("0 0 0 1 / 1 1 -2 3 / 0 0 5e-7 / 2e-7 / 90"), [],
     ["input.prm:", "b . n", "[11-23]", "(0001)"]),
    ("slip on {123} that is not switched on", IRON.format("1 2 -3 / 1 1 1 / 0 0 5e-7 / 2e-7 / 90"), [],
     ["input.prm:", "(12-3)", "[111]", "bcc", "(01-1)", "(11-2)"]),
    ("Burgers vector of another lattice", IRON.format("0 0 1 / 1 1 0 / 0 0 5e-7 / 2e-7 / 90"), [],
     ["input.prm:", "[110]", "bcc", "a/2<111>", "a<100>"]),
    ("Burgers vector a<100> of fcc",
     "subsection Microstructure\n set Loops = 1 0 0 / 1 0 0 / 0 0 5e-7 / 1e-7 / 12\nend\n", [],
     ["input.prm:", "Loops", "[100]", "fcc", "a/2<110>"]),
    ("glide loop on a plane that does not slip",
     "subsection Microstructure\n set Loops = 0 0 1 / 1 1 0 / 0 0 5e-7 / 1e-7 / 12\nend\n", [],
     ["input.prm:", "Loops", "(001)", "(-111)", "(1-11)"]),
    ("glide loop without corners",
     "subsection Microstructure\n set Loops = 1 1 1 / 1 -1 0 / 0 0 5e-7 / 1e-7 / 0\nend\n", [],
     ["input.prm:", "Loops", "3 to 1000 corners"]),
    ("{123} planes in fcc", "subsection Crystal\n set Slip on 123 planes = true\nend\n", [],
     ["input.prm:", "Slip on 123 planes", "bcc", "fcc"]),
    ("axial ratio of a cubic crystal", "subsection Crystal\n set c over a = 1.6\nend\n", [],
     ["input.prm:", "c over a", "fcc", "hcp"]),
    ("absurd axial ratio", ZIRCONIUM.format("") + "subsection Crystal\n set c over a = 16\nend\n", [],
     ["input.prm:", "c over a = 16", "0.5", "3"]),
    ("mobility law of another lattice", "subsection Mobility\n set Law = kink pair\nend\n", [],
     ["input.prm:", "Mobility/Law", "bcc", "fcc"]),
    ("kink pairs without parameters", IRON.format("") + "subsection Mobility\n set Law = kink pair\nend\n", [],
     ["Mobility/Edge drag", "must be given", "iron"]),
    ("drag of a family of another lattice", "subsection Mobility\n set Family drags = basal <a>: 1e-4 1e-4\nend\n", [],
     ["input.prm:", "Family drags", "'basal <a>' is no family", "{111}<110>"]),
    ("drag of a family that is no number", "subsection Mobility\n set Family drags = {111}<110>: fast\nend\n", [],
     ["input.prm:", "Family drags", "EDGE SCREW"]),
    ("friction of another law", "subsection Mobility\n set Law = relaxation\n set Friction stress = 1e7\nend\n", [],
     ["input.prm:", "Mobility/Friction stress", "belongs to Mobility/Law = linear"]),
    ("consistent velocities with friction", "subsection Mobility\n set Velocities = consistent\n set Friction stress = 1e7\nend\n", [],
     ["input.prm:", "Mobility/Velocities", "friction stress"]),
    ("two indices", "subsection Crystal\n set Direction along x = 1 1\nend\n", [],
     ["input.prm:", "Direction along x = 1 1", "three or four"]),
    ("network file of another crystal",
     IRON.format("") + "subsection Microstructure\n set Network file = other.data\nend\n", [],
     ["Microstructure", "Burgers vector", "no translation", "bcc", "a/2<111>"]),
    ("segment limits", "subsection Discretisation\n set Maximum segment = 1.6e-8\nend\n", [],
     ["input.prm:", "Maximum segment", "twice"]),
    ("face that does not exist", "subsection Boundary conditions\n set Platen face = top\nend\n", [],
     ["Platen face", "top", "z+"]),
    ("stage of an unknown kind", "subsection Loading\n set Type = stages\n set Stages = pull 3 until duration 1\nend\n", [],
     ["input.prm:", "Loading/Stages", "there is no kind 'pull'", "strain rate"]),
    ("stages that are not asked for", "subsection Loading\n set Stages = hold\nend\n", [],
     ["Loading/Stages", "needs Loading/Type = stages"]),
    ("strain of an infinite body", "", ["--set", "Mode=infinite", "--set", "Loading/Type=stages", "--set", "Loading/Stages=hold"],
     ["Loading/Type", "no strain to prescribe"]),
    ("load of a grain that is not held", "", ["--set", "Boundary conditions/Platen motion=none"],
     ["Loading/Type", "Platen motion = none has no load"]),
    ("machine that twists", "", ["--set", "Boundary conditions/Platen motion=twist", "--set", "Loading/Machine stiffness=1e3"],
     ["Loading/Machine stiffness", "pulls or pushes"]),
    ("bending about the axis", "", ["--set", "Boundary conditions/Platen motion=bending", "--set", "Boundary conditions/Transverse axis=z"],
     ["Boundary conditions/Transverse axis = z", "two axes across"]),
    ("loading that the mode does not have", "subsection Loading\n set Type = stress\nend\n", [], ["input.prm:", "Loading/Type"]),
]


def attempt(arguments, directory):
    return subprocess.run([program] + arguments, cwd=directory, capture_output=True, text=True, timeout=120)


def check(name, result, words, directory, before):
    message = result.stderr.strip()
    problems = []
    if result.returncode != 2:
        problems.append(f"exit status {result.returncode}")
    if len(message.splitlines()) != 1:
        problems.append(f"{len(message.splitlines())} lines")
    problems += [f"no '{w}'" for w in words if w not in message]
    if sorted(os.listdir(directory)) != before:
        problems.append("something was written")
    print(f"{'FAILED' if problems else 'ok':7} {name}: {message}" + (f"   <-- {', '.join(problems)}" if problems else ""))
    return not problems


passed = failed = 0
for name, text, extra, words in CASES:
    with tempfile.TemporaryDirectory() as directory:
        with open(example) as f:
            base = f.read()
        with open(os.path.join(directory, "input.prm"), "w") as f:
            f.write(base + "\n" + text)
        with open(os.path.join(directory, "open.data"), "w") as f:
            f.write(OPEN_B)
        with open(os.path.join(directory, "other.data"), "w") as f:
            f.write(OTHER_B)
        before = sorted(os.listdir(directory))
        good = check(name, attempt(["run", "input.prm", "-o", "out"] + extra, directory), words, directory, before)
        passed, failed = passed + good, failed + (not good)
with tempfile.TemporaryDirectory() as directory:
    good = check("missing input file", attempt(["run", "nowhere.prm", "-o", "out"], directory), ["nowhere.prm"], directory, [])
    passed, failed = passed + good, failed + (not good)
    usage = attempt(["rnu"], directory)
    passed, failed = passed + (usage.returncode == 2), failed + (usage.returncode != 2)
print(f"{passed} passed, {failed} failed")
sys.exit(1 if failed else 0)
