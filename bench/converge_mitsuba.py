"""Mitsuba 3 for converge.py: converge_mitsuba.py THREADS [VARIANT]. Its fastest variant for processors: with LLVM, where
that works, compiled before the clock starts; else the scalar one. Its sampler with the least noise in these scenes."""

import os
import sys
import tempfile
import time

import mitsuba as mi
import numpy

from converge_peer import cpu_seconds, serve


def rgb(color):
    return {"type": "rgb", "value": list(color)}


def material_of(m):
    if "matt" in m:
        return {"type": "twosided", "inner": {"type": "diffuse", "reflectance": rgb(m["matt"])}}
    if "metal" in m:
        return {"type": "roughconductor", "distribution": "ggx", "alpha": m["metal"]**2, "material": "none"}
    if "mirror" in m:
        return {"type": "conductor", "material": "none", "specular_reflectance": rgb(m["mirror"])}
    if "glass" in m:
        return {"type": "dielectric", "int_ior": m["glass"], "ext_ior": 1.0}
    return {"type": "diffuse", "reflectance": rgb([0, 0, 0])}


def write_ply(path, thing):
    lines = ["ply", "format ascii 1.0", f"element vertex {len(thing['vertices'])}",
             "property float x", "property float y", "property float z",
             f"element face {len(thing['faces'])}", "property list uchar int vertex_indices", "end_header"]
    lines += [" ".join(f"{v:.9g}" for v in vertex) for vertex in thing["vertices"]]
    lines += ["3 " + " ".join(map(str, face)) for face in thing["faces"]]
    with open(path, "w", encoding="ascii") as file:
        file.write("\n".join(lines) + "\n")


class Mitsuba:
    PASS = 256  # Samples at a time: with LLVM all of them are in memory at once.

    def __init__(self, threads, variant=None):
        mi.set_variant(variant or ("llvm_ad_rgb" if self.has_llvm() else "scalar_rgb"))
        self.compiles = mi.variant().startswith("llvm")
        if self.compiles:
            import drjit
            drjit.set_thread_count(threads)
        else:
            mi.Thread.set_thread_count(threads)

    @staticmethod
    def has_llvm():
        """Tried in another process, as it may end this one."""
        pid = os.fork()
        if pid == 0:
            try:
                mi.set_variant("llvm_ad_rgb")
                import drjit
                drjit.eval(drjit.llvm.Float(1) + drjit.arange(drjit.llvm.Float, 2))
                os._exit(0)
            except Exception:  # whatever it is that LLVM lacks
                os._exit(1)
        return os.waitpid(pid, 0)[1] == 0

    def version(self):
        return f"Mitsuba {mi.__version__}, {mi.variant()}"

    def prepare(self, scene, size):
        transform = mi.ScalarTransform4f
        tree = {
            "type": "scene",
            "integrator": {"type": "path", "max_depth": scene["depth"] + 1, "rr_depth": scene["depth"] + 1},
            "sensor": {"type": "perspective", "fov": scene["fov"],
                       "to_world": transform.look_at(origin=scene["eye"], target=scene["target"], up=[0, 1, 0]),
                       "film": {"type": "hdrfilm", "width": size, "height": size, "rfilter": {"type": "box"},
                                "component_format": "float32", "pixel_format": "rgb"},
                       "sampler": {"type": "multijitter"}},
        }
        if any(scene["sky"]):
            tree["sky"] = {"type": "constant", "radiance": rgb(scene["sky"])}
        if scene["sun"]:
            tree["sun"] = {"type": "directional", "direction": [-v for v in scene["sun"]["to"]],
                           "irradiance": rgb(scene["sun"]["irradiance"])}
        for number, lamp in enumerate(scene["lamps"]):
            u, v, c = (numpy.array(lamp[key], dtype=float) for key in ("u", "v", "center"))
            n = numpy.cross(u, v) / numpy.linalg.norm(numpy.cross(u, v))
            to_world = numpy.eye(4)
            to_world[:3, 0], to_world[:3, 1], to_world[:3, 2], to_world[:3, 3] = u / 2, v / 2, n, c
            tree[f"lamp{number}"] = {"type": "rectangle", "to_world": transform(to_world), "bsdf": material_of({}),
                                     "emitter": {"type": "area", "radiance": rgb(lamp["radiance"])}}
        with tempfile.TemporaryDirectory() as folder:
            for number, thing in enumerate(scene["things"]):
                path = os.path.join(folder, f"{number}.ply")
                write_ply(path, thing)
                tree[f"thing{number}"] = {"type": "ply", "filename": path, "face_normals": True,
                                          "bsdf": material_of(thing["material"])}
                if "shines" in thing["material"]:
                    tree[f"thing{number}"]["emitter"] = {"type": "area", "radiance": rgb(thing["material"]["shines"])}
            self.scene = mi.load_dict(tree)
        self.compiled = set()

    def render(self, samples, seed):
        passes = max(samples // self.PASS, 1) if self.compiles else 1
        each = samples // passes

        def once(number):
            return numpy.array(mi.render(self.scene, spp=each, seed=seed * 4096 + number)).astype(float)

        if self.compiles and each not in self.compiled:
            once(0)
            self.compiled.add(each)
        start, used = time.perf_counter(), cpu_seconds()
        picture = sum(once(number) for number in range(passes)) / passes
        return picture, time.perf_counter() - start, cpu_seconds() - used


if __name__ == "__main__":
    serve(Mitsuba(int(sys.argv[1]), *sys.argv[2:]))
