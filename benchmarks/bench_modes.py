"""Modes of elastic bodies: assembly, modes, memory, and a load from the store. CPU time on one
core, each row in a process of its own.

Asked: 62,109 degrees of freedom (520 x 420 x 8 mm as 60 x 48 x 1 twenty-node bricks): assembly 2 s,
60 modes 20 s, 1.5 GB at most; 105,633 degrees of freedom 40 s; the plate element 2 s at the same
accuracy; a stored basis loads in 50 ms.
"""

from __future__ import annotations

import os

# before NumPy is loaded: what is measured is one core
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import resource
import subprocess
import sys
import tempfile
import time

import numpy as np

from vibroimpact.materials import find_material
from vibroimpact.structures.damping import ConstantRatio
from vibroimpact.structures.finite_elements.lattice import box_mesh
from vibroimpact.structures.finite_elements.mesh import Mesh
from vibroimpact.structures.finite_elements.plate_mesh import plate_mesh
from vibroimpact.structures.finite_elements.structure import plate_structure, solid_structure
from vibroimpact.structures.modal_model import modal_basis, modal_model
from vibroimpact.structures.modes import ElasticSystem
from vibroimpact.structures.store import key_of, load_model, save_model
from vibroimpact.structures.supports.support import held_by

SIZE, MODES = (0.52, 0.42, 0.008), 60
STEEL = find_material("steel-paper")
MESHES = {
    "bricks 60 x 48 x 1": lambda: box_mesh(SIZE, (60, 48, 1)),
    "bricks 60 x 48 x 2": lambda: box_mesh(SIZE, (60, 48, 2)),
    "bricks 104 x 48 x 1": lambda: box_mesh(SIZE, (104, 48, 1)),
    "plate elements, 60 mm": lambda: plate_mesh(SIZE[:2], 0.06),
    "plate elements, 30 mm": lambda: plate_mesh(SIZE[:2], 0.03),
}


def measure(name: str) -> None:
    """Print a row of one mesh."""
    mesh: Mesh = MESHES[name]()
    import skfem  # noqa: F401  # its import is not assembly

    begin = time.process_time()
    structure = (
        plate_structure(mesh, STEEL, SIZE[2]) if mesh.is_flat else solid_structure(mesh, STEEL)
    )
    assembled = time.process_time()
    held = held_by(structure)
    elastic = ElasticSystem(held.stiffness, held.mass, held.rigid, held.order)
    factorised = time.process_time()
    modes = elastic.modes(MODES)
    done = time.process_time()
    model = modal_model(held, modes)
    loads = []
    with tempfile.TemporaryDirectory() as folder:
        os.environ["VIBROIMPACT_STORE"] = folder
        save_model(key_of(name), model)
        for _ in range(5):
            start = time.perf_counter()
            found, _ = load_model(key_of(name))
            assert found is not None
            modal_basis(found, ConstantRatio(0.01), (0.0, 0.0), "upper")
            loads.append(time.perf_counter() - start)
    memory = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1e6
    first, last = modes.angular_frequencies[[0, -1]] / (2.0 * np.pi)
    print(
        f"{name:22} {held.stiffness.shape[0]:7d} {assembled - begin:9.2f} "
        f"{factorised - assembled:9.2f} {done - begin:9.2f} "
        f"{memory:9.2f} {1e3 * float(np.median(loads)):9.1f} {first:10.3f} {last:10.2f}",
        flush=True,
    )


def main() -> None:
    """Print a row a mesh."""
    print(f"{MODES} modes of a free steel plate of 520 x 420 x 8 mm")
    print(
        f"{'mesh':22} {'dofs':>7} {'assembly':>9} {'factors':>9} {'all':>9} {'memory':>9} "
        f"{'load':>9} {'mode 1':>10} {f'mode {MODES}':>10}"
    )
    print(
        f"{'':22} {'':>7} {'[s]':>9} {'[s]':>9} {'[s]':>9} {'[GB]':>9} {'[ms]':>9} "
        f"{'[Hz]':>10} {'[Hz]':>10}",
        flush=True,
    )
    for name in MESHES:
        subprocess.run([sys.executable, __file__, name], check=True)


if __name__ == "__main__":
    if len(sys.argv) > 1:
        measure(sys.argv[1])
    else:
        main()
