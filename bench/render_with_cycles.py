"""Renders a scene that make_scenes.py has written with Blender's Cycles.

    blender -b --factory-startup -noaudio --debug-cycles --python bench/render_with_cycles.py -- \\
        SCENE.json OUT.png SAMPLES THREADS

With --debug-cycles Blender says how long the render took without loading and building.
"""

import array
import json
import math
import os
import sys

import bpy
from mathutils import Matrix, Vector

path, out, samples, threads = sys.argv[sys.argv.index("--") + 1:]
with open(path, encoding="ascii") as file:
    scene = json.load(file)

bpy.ops.wm.read_factory_settings(use_empty=True)
world = bpy.context.scene
world.world = bpy.data.worlds.new("dark")
world.world.use_nodes = True
world.world.node_tree.nodes["Background"].inputs["Strength"].default_value = 0


def material(name, m):
    """A diffuse surface with a glossy highlight, light of its own for the ambient term, and a mirror."""
    result = bpy.data.materials.new(name)
    result.use_nodes = True
    nodes, links = result.node_tree.nodes, result.node_tree.links
    nodes.clear()
    parts = []

    def part(kind, color, **inputs):
        node = nodes.new(kind)
        node.inputs["Color"].default_value = (*color, 1)
        for key, value in inputs.items():
            node.inputs[key.capitalize()].default_value = value
        parts.append(node.outputs[0])

    part("ShaderNodeBsdfDiffuse", m["diffuse"])
    part("ShaderNodeEmission", m["ambient"])
    if m["specular"]:
        # Phong's (R.V)^n is about as wide as a glossy lobe of this roughness, and as high with this colour.
        part("ShaderNodeBsdfGlossy", [0.1 * m["specular"]] * 3, roughness=math.sqrt(math.sqrt(2 / (m["shininess"] + 2))))
    if m["reflect"]:
        part("ShaderNodeBsdfGlossy", [m["reflect"]] * 3, roughness=0)
    total = parts[0]
    for one in parts[1:]:
        add = nodes.new("ShaderNodeAddShader")
        links.new(total, add.inputs[0])
        links.new(one, add.inputs[1])
        total = add.outputs[0]
    links.new(total, nodes.new("ShaderNodeOutputMaterial").inputs["Surface"])
    # The ambient term lights nothing else.
    if hasattr(result.cycles, "emission_sampling"):
        result.cycles.emission_sampling = "NONE"
    else:
        result.cycles.sample_as_light = False
    return result


def show(mesh, look, at=None):
    if look.name not in mesh.materials:
        mesh.materials.append(look)
    thing = bpy.data.objects.new(mesh.name, mesh)
    if at is not None:
        thing.matrix_world = at
    world.collection.objects.link(thing)


def mesh_of_file(name):
    with open(name, "rb") as file:
        counts, points, triangles = array.array("I"), array.array("f"), array.array("I")
        counts.fromfile(file, 2)
        points.fromfile(file, 3 * counts[0])
        triangles.fromfile(file, 3 * counts[1])
    mesh = bpy.data.meshes.new("knot")
    mesh.vertices.add(counts[0])
    mesh.vertices.foreach_set("co", points)
    mesh.loops.add(3 * counts[1])
    mesh.loops.foreach_set("vertex_index", triangles)
    mesh.polygons.add(counts[1])
    mesh.polygons.foreach_set("loop_start", range(0, 3 * counts[1], 3))
    mesh.polygons.foreach_set("loop_total", [3] * counts[1])
    mesh.polygons.foreach_set("use_smooth", [True] * counts[1])
    mesh.update()
    return mesh


def unit_sphere():
    """Cycles has no spheres but those of point clouds and meshes; here it is one mesh, shown many times."""
    bpy.ops.mesh.primitive_ico_sphere_add(subdivisions=5, radius=1)
    made = bpy.context.object
    mesh = made.data
    mesh.polygons.foreach_set("use_smooth", [True] * len(mesh.polygons))
    bpy.data.objects.remove(made)
    return mesh


look = material("object", scene["object"])
if "mesh" in scene:
    show(mesh_of_file(os.path.join(os.path.dirname(path), scene["mesh"] + ".bin")), look)
elif scene["spheres"]:
    ball = unit_sphere()
    for x, y, z, radius in scene["spheres"]:
        show(ball, look, Matrix.Translation((x, y, z)) @ Matrix.Scale(radius, 4))

floor = bpy.data.meshes.new("floor")
far, height = 300, scene["floor_height"]
floor.from_pydata([(-far, -far, height), (far, -far, height), (far, far, height), (-far, far, height)], [],
                  [(0, 1, 2, 3)])
show(floor, material("floor", scene["floor"]))

for i, one in enumerate(scene["lights"]):
    light = bpy.data.lights.new(f"light {i}", "POINT")
    light.shadow_soft_size = 0
    light.use_nodes = True
    nodes, links = light.node_tree.nodes, light.node_tree.links
    fade = nodes.new("ShaderNodeLightFalloff")  # a light that does not fade
    # A diffuse surface of albedo a that faces it sends back a * intensity.
    light.energy = 1
    fade.inputs["Strength"].default_value = 4 * math.pi**2 * one["intensity"]
    links.new(fade.outputs["Constant"], nodes["Emission"].inputs["Strength"])
    thing = bpy.data.objects.new(light.name, light)
    thing.location = one["position"]
    world.collection.objects.link(thing)

said = scene["camera"]
eye, forward = Vector(said["eye"]), (Vector(said["target"]) - Vector(said["eye"])).normalized()
right = forward.cross(Vector(said["up"])).normalized()
up = right.cross(forward)
camera = bpy.data.cameras.new("camera")
camera.sensor_fit = "VERTICAL"
camera.angle = math.radians(said["fov"])
camera.clip_start = 1e-3
stand = bpy.data.objects.new("camera", camera)
stand.matrix_world = Matrix.Translation(eye) @ Matrix((right, up, -forward)).transposed().to_4x4()
world.collection.objects.link(stand)
world.camera = stand

world.render.engine = "CYCLES"
world.render.resolution_x, world.render.resolution_y = scene["size"]
world.render.resolution_percentage = 100
world.render.threads_mode, world.render.threads = "FIXED", int(threads)
world.render.image_settings.file_format = "PNG"
world.render.filepath = out
world.view_settings.view_transform = "Standard"
cycles = world.cycles
cycles.device = "CPU"
cycles.samples = int(samples)
cycles.use_adaptive_sampling = False
cycles.use_denoising = False
cycles.pixel_filter_type = "BOX"
cycles.filter_width = 1
# Nothing but lights seen directly, and mirrors.
cycles.max_bounces = cycles.glossy_bounces = scene["max_depth"] - 1
cycles.diffuse_bounces = cycles.transmission_bounces = cycles.transparent_max_bounces = 0
cycles.caustics_reflective = cycles.caustics_refractive = False
cycles.sample_clamp_indirect = 0
bpy.ops.render.render(write_still=True)
