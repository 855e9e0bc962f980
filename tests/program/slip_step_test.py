#!/usr/bin/env python3
"""The surface that a run writes after a loop has left: two blocks, shifted by the Burgers vector along the trace of the glide plane.

usage: slip_step_test.py DDFEM EXAMPLES
"""
import os
import subprocess
import sys
import tempfile

import numpy as np

program, examples = os.path.abspath(sys.argv[1]), sys.argv[2]
sys.path.insert(0, examples)
import output_reader as reader  # noqa: E402

# A loop in the middle of a small pillar, blown out through its sides by a large stress; then the load is taken off.
INPUT = """subsection Crystal
 set Direction along x = 1 2 -1
 set Direction along z = -1 3 5
end
subsection Domain
 set Origin = -6e-8 -6e-8 0
 set Size = 1.2e-7 1.2e-7 2.8e-7
 set Subdivisions = 2 2 4
end
subsection Boundary conditions
 set Platen contact = frictionless
 set Reference state = perfect crystal
end
subsection Loading
 set Type = stages
 set Stages = constant stress -1.2e9 until duration 3e-11; free until duration 1e-13
end
subsection Microstructure
 set Loops = 1 1 1 / -1 0 1 / 0 0 1.4e-7 / 4.5e-8 / 12
end
subsection Discretisation
 set Minimum segment = 1.2e-8
 set Maximum segment = 3e-8
end
subsection Time stepping
 set Maximum steps = 300
 set Position tolerance = 3e-9
end
subsection Output
 set Frame interval = 0
end
"""


def unit(v):
    return np.array(v, float) / np.linalg.norm(v)


def main():
    z, x = unit([-1, 3, 5]), unit([1, 2, -1])
    axes = np.array([x, np.cross(z, x), z])
    normal, slip = axes @ unit([1, 1, 1]), axes @ unit([-1, 0, 1])
    with tempfile.TemporaryDirectory() as folder:
        path, results = os.path.join(folder, 'input.prm'), os.path.join(folder, 'results')
        with open(path, 'w') as f:
            f.write(INPUT)
        subprocess.run([program, 'run', path, '-o', results], check=True, stdout=subprocess.DEVNULL)
        history, grain = reader.history(results), reader.grain(reader.frames(results, 'grain')[-1][2])
        b = reader.log_number(results, r'b = ([\d.e+-]+) nm') * 1e-9
    if history['segments'][-1] != 0 or history['stress [Pa]'][-1] != 0:
        sys.exit('the loop has not left, or the pillar is still loaded')
    u = grain['displacement_m'].astype(float) / b
    above = (grain['points'].astype(float) - [0, 0, 1.4e-7]) @ normal > 0
    blocks = [u[above].mean(axis=0), u[~above].mean(axis=0)]
    # Without load the blocks are rigid. Files are in single precision (1e-7 of displacements up to b); the response to the load is
    # known to the elastic tolerance of 1e-7, and 1e-7 of the strain of 0.017 over 280 nm is 2e-6 b.
    limit = 1e-5
    step = blocks[0] - blocks[1]
    errors = {'step - b': min(np.linalg.norm(step - slip), np.linalg.norm(step + slip)),
              'above the plane': np.linalg.norm(u[above] - blocks[0], axis=1).max(),
              'below the plane': np.linalg.norm(u[~above] - blocks[1], axis=1).max()}
    for name, error in errors.items():
        print(f'{name:20s} {error:.2e} b, limit {limit:.0e}')
    sys.exit(any(error > limit for error in errors.values()))


if __name__ == '__main__':
    main()
