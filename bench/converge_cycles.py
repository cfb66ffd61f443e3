"""Blender's Cycles, as the module bpy, for converge.py: converge_cycles.py THREADS."""

import math
import os
import re
import sys
import tempfile
import time

import bpy
import numpy
from mathutils import Matrix, Vector

from converge_peer import cpu_seconds, serve


def material_of(m):
    result = bpy.data.materials.new("material")
    result.use_nodes = True
    nodes, links = result.node_tree.nodes, result.node_tree.links
    nodes.clear()
    kind = {"matt": "ShaderNodeBsdfDiffuse", "metal": "ShaderNodeBsdfAnisotropic", "mirror": "ShaderNodeBsdfAnisotropic",
            "glass": "ShaderNodeBsdfGlass", "shines": "ShaderNodeEmission"}[next(iter(m))]
    node = nodes.new(kind)
    color = m.get("matt") or m.get("mirror") or m.get("shines") or [1, 1, 1]
    node.inputs["Color"].default_value = (*color, 1)
    if "metal" in m or "mirror" in m:
        node.distribution = "GGX"
    if "Roughness" in node.inputs:
        node.inputs["Roughness"].default_value = m.get("metal", 0)
    if "glass" in m:
        node.inputs["IOR"].default_value = m["glass"]
    if "shines" in m:
        node.inputs["Strength"].default_value = 1
    links.new(node.outputs[0], nodes.new("ShaderNodeOutputMaterial").inputs["Surface"])
    return result


class Cycles:
    def __init__(self, threads):
        self.threads = threads

    def version(self):
        return f"Cycles of Blender {bpy.app.version_string}"

    def prepare(self, scene, size):
        bpy.ops.wm.read_factory_settings(use_empty=True)
        stage = bpy.context.scene
        stage.world = bpy.data.worlds.new("sky")
        stage.world.use_nodes = True
        sky = stage.world.node_tree.nodes["Background"]
        sky.inputs["Color"].default_value, sky.inputs["Strength"].default_value = (*scene["sky"], 1), 1

        # Blender's z points up, but nothing here depends on it.
        def show(data, at=None):
            made = bpy.data.objects.new(data.name, data)
            if at is not None:
                made.matrix_world = at
            stage.collection.objects.link(made)
            return made

        def frame(x, y, z, origin):
            turned = Matrix((x, y, z)).transposed().to_4x4()
            return Matrix.Translation(Vector(origin)) @ turned

        def across(z):
            x = z.cross(Vector((0, 1, 0)) if abs(z.y) < 0.9 else Vector((1, 0, 0))).normalized()
            return x, z.cross(x)

        eye, target = Vector(scene["eye"]), Vector(scene["target"])
        back = (eye - target).normalized()
        right = Vector((0, 1, 0)).cross(back).normalized()
        camera = bpy.data.cameras.new("camera")
        camera.angle, camera.clip_start = math.radians(scene["fov"]), 1e-3
        stage.camera = show(camera, frame(right, back.cross(right), back, eye))

        for lamp in scene["lamps"]:
            u, v = Vector(lamp["u"]), Vector(lamp["v"])
            light = bpy.data.lights.new("lamp", "AREA")
            light.shape, light.size, light.size_y = "RECTANGLE", u.length, v.length
            # Of the radiance L it sends pi L for each unit of its area.
            most = max(lamp["radiance"])
            light.energy, light.color = math.pi * u.length * v.length * most, [c / most for c in lamp["radiance"]]
            # It shines along its -z.
            n = u.cross(v).normalized()
            show(light, frame(u.normalized(), -v.normalized(), -n, lamp["center"])).visible_camera = True
        if scene["sun"]:
            light = bpy.data.lights.new("sun", "SUN")
            most = max(scene["sun"]["irradiance"])
            light.angle, light.energy = 0, most
            light.color = [c / most for c in scene["sun"]["irradiance"]]
            to_sun = Vector(scene["sun"]["to"])
            show(light, frame(*across(to_sun), to_sun, to_sun))

        for thing in scene["things"]:
            mesh = bpy.data.meshes.new("thing")
            mesh.from_pydata(thing["vertices"], [], thing["faces"])
            mesh.materials.append(material_of(thing["material"]))
            show(mesh)

        render, cycles = stage.render, stage.cycles
        render.engine = "CYCLES"
        render.resolution_x = render.resolution_y = size
        render.resolution_percentage = 100
        render.threads_mode, render.threads = "FIXED", self.threads
        render.image_settings.file_format, render.image_settings.color_mode = "OPEN_EXR", "RGB"
        render.image_settings.color_depth, render.image_settings.exr_codec = "32", "NONE"
        cycles.device = "CPU"
        cycles.use_adaptive_sampling = cycles.use_denoising = cycles.use_auto_tile = False
        cycles.pixel_filter_type, cycles.filter_width = "BOX", 1
        cycles.light_sampling_threshold = cycles.blur_glossy = 0
        cycles.sample_clamp_direct = cycles.sample_clamp_indirect = 0
        cycles.caustics_reflective = cycles.caustics_refractive = True
        # Bounces: rays after the one from the eye. No Russian roulette among them.
        bounces = scene["depth"] - 1
        cycles.max_bounces = cycles.diffuse_bounces = cycles.glossy_bounces = cycles.transmission_bounces = bounces
        cycles.transparent_max_bounces = 1024
        # Sample 0 goes through the centre of every pixel, so that edges would be off in all pictures; the others do not.
        cycles.sample_offset = 65536
        cycles.min_light_bounces = cycles.min_transparent_bounces = 1024
        self.render(1, 0)  # loads what it loads once

    def render(self, samples, seed):
        stage = bpy.context.scene
        stage.cycles.samples, stage.cycles.seed = samples, seed
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "picture.exr")
            stage.render.filepath = path
            start, used = time.perf_counter(), cpu_seconds()
            bpy.ops.render.render(write_still=True)
            seconds, cpu = time.perf_counter() - start, cpu_seconds() - used
            image = bpy.data.images.load(path)
            image.colorspace_settings.name = "Non-Color"
            width, height = image.size
            values = numpy.empty(width * height * image.channels, dtype=numpy.float32)
            image.pixels.foreach_get(values)
            picture = values.reshape(height, width, image.channels)[::-1, :, :3].astype(float)
            bpy.data.images.remove(image)
            with open(path, "rb") as file:
                head = file.read(8192)
        # Its own clock for rendering, without handing over the scene and without building the tree.
        told = re.search(rb"\.render_time\0string\0....(?:(\d+):)?(\d+):([\d.]+)", head, re.DOTALL)
        hours, minutes, rest = told.groups()
        own = 3600 * int(hours or 0) + 60 * int(minutes) + float(rest)
        return picture, min(own, seconds), cpu


if __name__ == "__main__":
    serve(Cycles(int(sys.argv[1])))
