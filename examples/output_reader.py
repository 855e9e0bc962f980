"""Reads the output of ddfem with numpy alone: history.csv, log.txt, frames of dislocations (ASCII) and of the grain (zlib)."""
import base64
import csv
import os
import re
import xml.etree.ElementTree as ElementTree
import zlib

import numpy as np

TYPES = {'Float32': '<f4', 'Float64': '<f8', 'Int8': 'i1', 'UInt8': 'u1', 'Int32': '<i4', 'UInt32': '<u4',
         'Int64': '<i8', 'UInt64': '<u8'}


def history(directory):
    """Columns of history.csv by their full names (with unit)."""
    with open(os.path.join(directory, 'history.csv')) as f:
        rows = list(csv.reader(f))
    data = np.array([[float(x) for x in row] for row in rows[1:]])
    return {name: data[:, k] for k, name in enumerate(rows[0])}


def log_number(directory, pattern):
    """First number that the regular expression captures in log.txt."""
    with open(os.path.join(directory, 'log.txt')) as f:
        match = re.search(pattern, f.read())
    if not match:
        raise ValueError(f'{directory}/log.txt: nothing matches {pattern}')
    return float(match[1])


def decode(array):
    """Numbers of a <DataArray>: ASCII, or base64 with a UInt32 header (compressed by zlib in blocks, or plain)."""
    kind = np.dtype(TYPES[array.get('type')])
    text = (array.text or '').strip()
    if not text:
        return np.empty(0, kind)
    if array.get('format') == 'ascii':
        values = np.array(text.split(), dtype=float).astype(kind)
    else:
        text = ''.join(text.split())
        n_blocks = int(np.frombuffer(base64.b64decode(text[:8])[:4], '<u4')[0])
        header_chars = 4 * ((4 * (3 + n_blocks) + 2) // 3)
        header = np.frombuffer(base64.b64decode(text[:header_chars])[:4 * (3 + n_blocks)], '<u4')
        body, start, parts = base64.b64decode(text[header_chars:]), 0, []
        for size in header[3:]:
            parts.append(zlib.decompress(body[start:start + size]))
            start += size
        values = np.frombuffer(b''.join(parts), kind)
    components = int(array.get('NumberOfComponents', 1))
    return values.reshape(-1, components) if components > 1 else values


def vtu(path):
    """Points, cells (list of index arrays), point data and cell data of one .vtu file."""
    piece = ElementTree.parse(path).getroot().find('UnstructuredGrid/Piece')
    cells = {a.get('Name'): decode(a) for a in piece.find('Cells')}
    if len(cells['offsets']) == 0:               # all cells have the same number of points
        n_cells = int(piece.get('NumberOfCells'))
        cells['offsets'] = np.arange(1, n_cells + 1) * (len(cells['connectivity']) // n_cells)
    result = {'points': decode(piece.find('Points')[0]), 'cells': np.split(cells['connectivity'], cells['offsets'][:-1])}
    for group in ('PointData', 'CellData'):
        for a in piece.find(group) if piece.find(group) is not None else []:
            result[a.get('Name')] = decode(a)
    return result


def frames(directory, name):
    """(time in s, step, path) of the frames of a collection, 'dislocations' or 'grain'."""
    result = []
    for data in ElementTree.parse(os.path.join(directory, f'{name}.pvd')).getroot().iter('DataSet'):
        path = data.get('file')
        result.append((float(data.get('timestep')), int(re.search(r'_(\d+)\.', path)[1]), os.path.join(directory, path)))
    return result


def segments(path):
    """Segments of a frame of dislocations: array (n, 2, 3) in m, and the frame itself."""
    frame = vtu(path)
    return frame['points'].reshape(-1, 2, 3), frame


def grain(path):
    """A frame of the grain: all pieces of the .pvtu, joined."""
    pieces = [vtu(os.path.join(os.path.dirname(path), p.get('Source')))
              for p in ElementTree.parse(path).getroot().iter('Piece')]
    joined, shift = dict(pieces[0]), len(pieces[0]['points'])
    for piece in pieces[1:]:
        joined['cells'] = joined['cells'] + [c + shift for c in piece['cells']]
        shift += len(piece['points'])
        for key in joined:
            if key != 'cells':
                joined[key] = np.concatenate([joined[key], piece[key]])
    return joined
