"""The round trip through Blender: a scene exported by the add-on is rendered by Lightloom and by Cycles and compared.

    pip install bpy==5.0.1 OpenEXR numpy        (Python 3.11)
    cargo build --release
    python tests/blender/round_trip.py [--lightloom target/release/lightloom] [--out DIR]

It is run by hand: bpy is no dependency of the project. Exit code 1 where a figure is beyond its tolerance.
"""

import argparse
import json
import math
import os
import subprocess
import sys
import tempfile

import bpy
import numpy as np
import OpenEXR
from mathutils import Vector

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
sys.path.insert(0, os.path.join(ROOT, "assets", "blender"))
import lightloom  # noqa: E402

# Markers register within a tenth of a pixel, light within one per cent.
PIXELS, LIGHT = 0.1, 0.01
# Light through glass: Cycles finds it by chance. In a box of 8 x 8 pixels in the focus its pictures of 2000 samples differ from seed
# to seed by 0.7 % (standard deviation); the mean of six by 0.3 %.
CAUSTIC, SEEDS, SAMPLES = 0.01, 6, 2000

# The picture without caustics; the few photons are not looked at.
BACKGROUND = ["--layers", "background", "--photons", "10000", "--passes", "1"]

failures = []


def verdict(name, value, tolerance, unit=""):
    good = value <= tolerance
    print(f"{'ok  ' if good else 'MISS'} {name}: {value:.4f}{unit} (tolerance {tolerance}{unit})", flush=True)
    if not good:
        failures.append(name)


# ------------------------------------------------------------------------------------------------------- scenes


def matt(name, albedo):
    material = bpy.data.materials.new(name)
    nodes = material.node_tree.nodes
    nodes.clear()
    shader, output = nodes.new("ShaderNodeBsdfDiffuse"), nodes.new("ShaderNodeOutputMaterial")
    shader.inputs["Color"].default_value = (albedo, albedo, albedo, 1)
    material.node_tree.links.new(shader.outputs[0], output.inputs["Surface"])
    return material


def glass(name, ior=1.5, colour=(1, 1, 1)):
    material = bpy.data.materials.new(name)
    shader = next(n for n in material.node_tree.nodes if n.type == "BSDF_PRINCIPLED")
    shader.inputs["Transmission Weight"].default_value = 1.0
    shader.inputs["Roughness"].default_value = 0.0
    shader.inputs["IOR"].default_value = ior
    shader.inputs["Base Color"].default_value = (*colour, 1)
    return material


def look_at(obj, place, target):
    obj.location = place
    obj.rotation_euler = (Vector(target) - Vector(place)).to_track_quat("-Z", "Y").to_euler()


def ball(name, radius, place, material):
    bpy.ops.mesh.primitive_uv_sphere_add(segments=96, ring_count=48, radius=radius, location=place)
    obj = bpy.context.object
    obj.name = name
    obj.data.polygons.foreach_set("use_smooth", [True] * len(obj.data.polygons))
    obj.data.materials.append(material)
    return obj


def empty_scene(width, height, albedo=0.5, sky=0.0):
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = bpy.context.scene
    scene.render.engine = "CYCLES"
    scene.cycles.device = "CPU"
    scene.cycles.use_denoising = scene.cycles.use_adaptive_sampling = False
    scene.cycles.sample_clamp_indirect = scene.cycles.sample_clamp_direct = 0
    scene.cycles.blur_glossy = 0
    scene.cycles.light_sampling_threshold = 0
    scene.cycles.caustics_refractive = scene.cycles.caustics_reflective = True
    scene.cycles.max_bounces = scene.cycles.transmission_bounces = 16
    scene.render.threads_mode, scene.render.threads = "FIXED", 2
    scene.render.resolution_x, scene.render.resolution_y = width, height
    scene.render.image_settings.file_format = "OPEN_EXR"
    scene.render.image_settings.color_depth = "32"
    world = bpy.data.worlds.new("world")
    scene.world = world
    next(n for n in world.node_tree.nodes if n.type == "BACKGROUND").inputs["Color"].default_value = (sky, sky, sky, 1)
    bpy.ops.mesh.primitive_plane_add(size=1.0, location=(0.05, -0.1, 0))
    plane = bpy.context.object
    plane.name, plane.scale = "Receiver", (3.0, 2.0, 1)
    plane.data.materials.append(matt("table", albedo))
    camera = bpy.data.objects.new("camera", bpy.data.cameras.new("camera"))
    scene.collection.objects.link(camera)
    look_at(camera, (0.3, -1.6, 1.1), (0, 0, 0))
    scene.camera = camera
    scene.frame_start, scene.frame_end = 5, 29
    scene.render.fps, scene.render.fps_base = 24, 1.001
    return scene


def lamp(scene, kind, place, target=(0, 0, 0), **values):
    data = bpy.data.lights.new(kind.lower(), kind)
    for name, value in values.items():
        setattr(data, name, value)
    obj = bpy.data.objects.new(kind.lower(), data)
    scene.collection.objects.link(obj)
    look_at(obj, place, target)
    return obj


# ------------------------------------------------------------------------------------------------------ pictures


def channels(path, prefix=""):
    """R, G, B of an EXR file whose channels bear a prefix, rows from above."""
    for part in OpenEXR.File(path, separate_channels=True).parts:
        if prefix + "R" in part.channels:
            return np.stack([np.asarray(part.channels[prefix + c].pixels, np.float64) for c in "RGB"], -1)
    raise SystemExit(f"{path} has no channels {prefix}R, ...")


def cycles(scene, path, samples):
    scene.cycles.samples = samples
    scene.render.filepath = path
    bpy.ops.render.render(write_still=True)
    return channels(path)


def exported(folder):
    path = os.path.join(folder, "scene.json")
    bpy.context.view_layer.update()
    notes = lightloom.export(bpy.context, path)
    with open(path, encoding="utf-8") as file:
        return path, json.load(file), notes


def rendered(program, path, folder, *more):
    """The first frame by Lightloom; the project must pass its check, too."""
    subprocess.run([program, "check", path], check=True, stdout=subprocess.DEVNULL)
    command = [program, "render", path, "--out", folder, "--frames", "5", "--format", "exr", "--overwrite", *more]
    subprocess.run(command, check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    return os.path.join(folder, "scene.0005.exr")


def pixel_of(scene, place):
    """The pixel of a point by Blender's own projection, from the upper left corner."""
    from bpy_extras.object_utils import world_to_camera_view

    at = world_to_camera_view(scene, scene.camera, Vector(place))
    width, height = lightloom.picture_size(scene)
    return np.array([at.x * width, (1 - at.y) * height])


# --------------------------------------------------------------------------------------------------------- tests

MARKERS = [(-0.45, -0.3, 0.02), (0.4, -0.35, 0.02), (-0.4, 0.3, 0.1), (0.45, 0.3, 0.02), (0, 0.02, 0.3), (0.1, -0.15, 0.02)]


def centroid(image, around, reach):
    """The centre of what is brighter than the table in a window, in pixels."""
    x, y = np.round(around).astype(int)
    window = image[max(y - reach, 0) : y + reach, max(x - reach, 0) : x + reach].mean(-1)
    floor = np.median(np.concatenate([window[0], window[-1], window[:, 0], window[:, -1]]))
    weight = np.clip(window - floor - 0.3 * (window.max() - floor), 0, None)
    rows, columns = np.mgrid[: window.shape[0], : window.shape[1]] + 0.5
    return np.array([(weight * columns).sum(), (weight * rows).sum()]) / weight.sum() + [max(x - reach, 0), max(y - reach, 0)]


def markers(program, folder):
    views = [
        ("AUTO", 480, 270, (0.0, 0.0)),
        ("AUTO", 480, 270, (0.12, -0.08)),
        ("VERTICAL", 480, 270, (-0.1, 0.15)),
        ("HORIZONTAL", 300, 400, (0.1, 0.05)),
        ("AUTO", 300, 400, (-0.05, -0.12)),
    ]
    for fit, width, height, shift in views:
        scene = empty_scene(width, height, albedo=0.05, sky=0.5)
        camera = scene.camera.data
        camera.sensor_fit, camera.sensor_height, camera.lens = fit, 22.0, 32.0
        camera.shift_x, camera.shift_y = shift
        # A wide view, so that the markers stay in every shifted picture.
        look_at(scene.camera, (0.4, -2.4, 1.5), (0, 0, 0.05))
        # Something that casts a caustic, in the light of a lamp too faint to matter.
        ball("glass", 0.01, (0.2, 0.1, 0.02), glass("glass"))
        lamp(scene, "POINT", (0.2, 0.1, 1.0), energy=1e-4, shadow_soft_size=0.0)
        white = matt("marker", 0.9)
        for place in MARKERS:
            ball("marker", 0.02, place, white)
        path, _, _ = exported(folder)
        ours = channels(rendered(program, path, folder, *BACKGROUND), "background.")
        theirs = cycles(scene, os.path.join(folder, "cycles.exr"), 96)
        worst, seen = 0.0, 0
        for place in MARKERS:
            at = pixel_of(scene, place)
            if not (16 < at[0] < width - 16 and 16 < at[1] < height - 16):
                continue
            seen += 1
            worst = max(worst, np.linalg.norm(centroid(ours, at, 11) - centroid(theirs, at, 11)))
        verdict(f"{seen} markers, fit {fit}, {width} x {height}, shift {shift}", worst, PIXELS, " px")
        if seen < 4:
            failures.append("too few markers in the picture")


PLACES = [(0.0, 0.0, 0), (-0.35, -0.25, 0), (0.4, -0.3, 0), (-0.3, 0.3, 0), (0.25, 0.25, 0)]


def box(image, at, reach=4):
    x, y = np.round(at).astype(int)
    return image[y - reach : y + reach, x - reach : x + reach].mean((0, 1))


def worst_light(scene, ours, theirs, places, reach=4, quiet=True):
    ratios = []
    for place in places:
        at = pixel_of(scene, place)
        ratios.append(box(ours, at, reach) / box(theirs, at, reach))
    if not quiet:
        print("     ratios:", ", ".join(f"{r.mean():.4f}" for r in ratios))
    return max(float(np.abs(r - 1).max()) for r in ratios)


def lamps(program, folder):
    kinds = [
        ("point", "POINT", (0.3, 0.2, 1.0), {"energy": 20.0, "shadow_soft_size": 0.0}),
        ("point of 0.1 m with soft falloff", "POINT", (0.3, 0.2, 1.0), {"energy": 20.0, "shadow_soft_size": 0.1}),
        ("point of 0.1 m, a sphere", "POINT", (0.3, 0.2, 1.0), {"energy": 20.0, "shadow_soft_size": 0.1, "use_soft_falloff": False}),
        ("spot", "SPOT", (-0.5, 0.3, 1.1), {"energy": 60.0, "spot_size": math.radians(60), "spot_blend": 0.6, "shadow_soft_size": 0.0}),
        ("area", "AREA", (-0.6, -0.4, 0.9), {"energy": 8.0, "shape": "RECTANGLE", "size": 0.5, "size_y": 0.2}),
        ("area straight down", "AREA", (0.1, 0.1, 0.7), {"energy": 8.0, "shape": "RECTANGLE", "size": 0.5, "size_y": 0.2}),
        ("area, exposure and colour", "AREA", (-0.6, -0.4, 0.9), {"energy": 4.0, "exposure": 1.0, "color": (1.0, 0.5, 0.25), "size": 0.3}),
        ("sun", "SUN", (0.5, 0.5, 1.0), {"energy": 3.0, "angle": math.radians(5)}),
    ]
    for name, kind, place, values in kinds:
        scene = empty_scene(320, 180)
        target = (place[0], place[1], 0) if "down" in name else (0, 0, 0)
        lamp(scene, kind, place, target, **values)
        # Something that casts a caustic, beside the five places.
        ball("glass", 0.01, (0.12, 0.12, 0.02), glass("glass"))
        path, _, _ = exported(folder)
        ours = channels(rendered(program, path, folder, *BACKGROUND), "background.")
        theirs = cycles(scene, os.path.join(folder, "cycles.exr"), 512)
        verdict(f"light at five places, {name}", worst_light(scene, ours, theirs, PLACES, quiet=False), LIGHT)


def caustic(program, folder):
    """A ball of glass before a large panel: Cycles finds this caustic by chance often enough."""
    scene = empty_scene(160, 90)
    lamp(scene, "AREA", (-0.7, 0.2, 0.8), (0, 0, 0.15), energy=30.0, shape="SQUARE", size=0.35)
    ball("glass", 0.15, (0, 0, 0.2), glass("glass", 1.45))
    path, _, _ = exported(folder)
    # A kernel of eight passes of a million photons dims the focus by 0.4 %.
    ours = channels(rendered(program, path, folder, "--layers", "beauty", "--photons", "4000000", "--passes", "16"))
    theirs = 0
    for seed in range(SEEDS):
        scene.cycles.seed = seed
        theirs = theirs + cycles(scene, os.path.join(folder, "cycles.exr"), SAMPLES) / SEEDS
    # The focus, its flank, and the table around.
    places = [(0.21, -0.055, 0), (0.31, -0.08, 0), (-0.3, -0.3, 0), (0.1, -0.4, 0), (-0.35, 0.1, 0)]
    worst = worst_light(scene, ours, theirs, places, quiet=False)
    verdict("light at five places, a ball of glass before a panel", worst, CAUSTIC)
    # All light that the ball sends to the table, and its shadow.
    around = (slice(38, 70), slice(75, 140))
    verdict("all light behind the ball", abs(ours[around].mean() / theirs[around].mean() - 1), LIGHT)


def layer(program, folder):
    """The caustic comes back as a layer: the composite is Cycles' picture plus the caustic."""
    scene = empty_scene(160, 90)
    lamp(scene, "SPOT", (-0.7, 0.2, 0.8), (0, 0, 0.15), energy=60.0, spot_size=0.6, shadow_soft_size=0.0)
    ball("glass", 0.15, (0, 0, 0.2), glass("glass", 1.45))
    path, project, _ = exported(folder)
    if project["keys"] != [{"frame": 5, "shows": "physical_caustic"}, {"frame": 29, "shows": "physical_caustic"}]:
        failures.append("frame range")
    if project["output"]["fps"] != [24000, 1001]:
        failures.append("frame rate")
    frame = rendered(program, path, folder, "--photons", "100000", "--passes", "2", "--layers", "beauty,caustic,background")
    scene.frame_set(5)
    scene.cycles.caustics_refractive = scene.cycles.caustics_reflective = False
    alone = cycles(scene, os.path.join(folder, "alone.exr"), 16)
    lightloom.load_layer(bpy.context, frame)
    both = cycles(scene, os.path.join(folder, "both.exr"), 16)
    added, wanted = both - alone, channels(frame, "caustic.")
    # Half floats carry eleven bits.
    verdict("the layer in the compositor", float(np.abs(added - wanted).max() / wanted.max()), 2e-3)


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--lightloom", default=os.path.join(ROOT, "target", "release", "lightloom"))
    parser.add_argument("--out", help="keeps the files there")
    parser.add_argument("--only", help="markers, lamps, caustic or layer")
    args = parser.parse_args()
    lightloom.register()
    for test in (markers, lamps, caustic, layer):
        if args.only in (None, test.__name__):
            with tempfile.TemporaryDirectory() as scratch:
                folder = os.path.join(args.out, test.__name__) if args.out else scratch
                os.makedirs(folder, exist_ok=True)
                test(args.lightloom, folder)
    lightloom.unregister()
    print("all within tolerance" if not failures else f"beyond tolerance: {failures}")
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
