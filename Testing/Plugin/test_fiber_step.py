"""From a phantom to a STEP file with the filters one by one; gmsh meshes the solid in 3D."""
import shutil
import subprocess

from bsrtesting import *

sys.path.insert(0, os.path.join(SOURCE_DIR, "Examples"))
import fiber_chain

volume = temp_file("chain_volume.vti")
step = temp_file("chain.step")
phantom = FiberPhantom(Seed=4, Dimensions=[112, 64, 64])
SaveData(volume, proxy=OutputPort(phantom, 0))
fiber_chain.LoadPlugin(PLUGIN, remote=False, ns=vars(fiber_chain))
fiber_chain.main(volume, step)
with open(step) as text:
    content = text.read()
check_equal(content.count("MANIFOLD_SOLID_BREP(") + content.count("BREP_WITH_VOIDS("), 1, "solids in the STEP file")
check_between(content.count("ADVANCED_FACE("), 100, 2000, "faces in the STEP file")
if shutil.which("gmsh"):
    mesh = temp_file("chain.msh")
    run = subprocess.run(["gmsh", "-3", "-clmin", "1.5", "-clmax", "6", "-format", "msh2", "-o", mesh, step],
                         capture_output=True, text=True, timeout=400)
    check_equal(run.returncode, 0, "gmsh's exit code")
    check("tetrahedra" in run.stdout or "Writing" in run.stdout, "gmsh says:\n" + run.stdout[-2000:])
    with open(mesh) as text:
        check(sum(line.split()[1:2] == ["4"] for line in text) > 1000, "tetrahedra in the mesh")
