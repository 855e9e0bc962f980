"""What plot.py and measure.py need to know of input.prm, in SI units and the sample frame."""
import os
import sys

import numpy as np

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), '..'))
import drawing  # noqa: E402,F401
import output_reader as reader  # noqa: E402,F401

WIDTH, HEIGHT = 500e-9, 1000e-9
SOURCE = np.array([0.0, 0.0, 500e-9])
AXES = np.array([[1, 2, -1], [0, 0, 0], [-1, 3, 5]], float)      # crystal directions of x, y, z
AXES /= np.maximum(np.linalg.norm(AXES, axis=1), 1e-30)[:, None]
AXES[1] = np.cross(AXES[2], AXES[0])
NORMAL = AXES @ np.array([1, 1, 1]) / np.sqrt(3)                 # of the glide plane
SLIP = AXES @ np.array([-1, 0, 1]) / np.sqrt(2)                  # direction of the Burgers vector
SCHMID = abs(NORMAL[2] * SLIP[2])
PLANE_AREA = WIDTH ** 2 / abs(NORMAL[2])                         # the plane meets the four sides only
VOLUME = WIDTH ** 2 * HEIGHT


def burgers(directory):
    return reader.log_number(directory, r'b = ([\d.e+-]+) nm') * 1e-9


def modulus(directory):
    return reader.log_number(directory, r'modulus under these boundary conditions ([\d.e+-]+) GPa') * 1e9


def strain_per_slip(b):
    """Axial plastic strain when the whole plane has slipped by b."""
    return b * PLANE_AREA * SCHMID / VOLUME
