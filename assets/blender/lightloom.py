"""Lightloom for Blender: a scene goes out as a project, and the rendered caustic comes back as a layer over the render.

Install it by Edit > Preferences > Add-ons > Install from Disk. It adds File > Export > Lightloom (.json) and
File > Import > Lightloom caustic layer (.exr). Without a window: `export(context, path)` and `load_layer(context, path)`.

Blender is Z-up and Lightloom Y-up: (x, y, z) becomes (x, z, -y). All lengths are in Blender's units, taken as metres.
"""

import json
import math
import os
import re

import bpy
import numpy as np
from bpy.props import BoolProperty, StringProperty
from bpy_extras.io_utils import ExportHelper, ImportHelper
from mathutils import Vector

bl_info = {
    "name": "Lightloom",
    "author": "The Lightloom developers",
    "version": (1, 0, 0),
    "blender": (4, 2, 0),
    "location": "File > Export, File > Import",
    "description": "Scenes to Lightloom, and caustics back as a layer over the render",
    "category": "Import-Export",
}

# The receiver by name, where the active object is no plane.
RECEIVER = "Receiver"
# Roughness up to which a surface counts as polished: Lightloom's glass and mirrors are.
POLISHED = 0.05
# Weight of transmission or metal from which a Principled BSDF counts as glass or as a mirror.
MOSTLY = 0.5
# A plane deviates by no more than this share of its size.
FLAT = 1e-4
# A direction whose horizontal part is below this looks straight up or down.
VERTICAL = 1e-4


def y_up(vector):
    """A vector of Blender's space in Lightloom's."""
    return [vector[0] + 0.0, vector[2] + 0.0, -vector[1] + 0.0]


def point_ahead(position, ahead):
    """A point that an object at `position` looks at: as far as that is from the origin, so that 32 bits hold the direction."""
    if Vector((ahead.x, ahead.y)).length < VERTICAL:
        ahead = Vector((0, 0, math.copysign(1, ahead.z)))
    return y_up(position + ahead * max(position.length, 1.0))


def clamped(colour):
    """A colour as shares of light, 0 to 1."""
    return [min(max(float(c), 0.0), 1.0) for c in list(colour)[:3]]


# ---------------------------------------------------------------------------------------------------- materials


def surface_node(material):
    """The shader node at the surface socket of a material's output; none without nodes."""
    tree = material.node_tree if material else None
    output = tree.get_output_node("ALL") if tree else None
    return linked(output, "Surface")


def volume_node(material):
    tree = material.node_tree if material else None
    output = tree.get_output_node("ALL") if tree else None
    return linked(output, "Volume")


def linked(node, socket):
    if node is None or not node.inputs[socket].is_linked:
        return None
    return node.inputs[socket].links[0].from_node


class Values:
    """The values of a node's sockets; sockets fed by a texture are told of and read at their own value."""

    def __init__(self, node, label, notes):
        self.node, self.label, self.notes = node, label, notes

    def get(self, name, default):
        socket = self.node.inputs.get(name) if self.node else None
        if socket is None:
            return default
        if socket.is_linked:
            self.notes.append(f"{self.label}: '{name}' comes from a node; its plain value is taken")
        return socket.default_value


def absorption(tint, thickness):
    """The coefficient (1/m) by which light that crosses `thickness` metres takes on the colour `tint`."""
    return [-math.log(max(c, 1e-6)) / thickness + 0.0 for c in clamped(tint)]


def glass_of(values, surfaces, material, thickness):
    """Glass whose tint is given by surface: Lightloom colours it by the way through it, the mean of which is `thickness`."""
    colour = clamped(values.get("Color" if surfaces == 2 else "Base Color", (1, 1, 1)))
    coefficient = absorption([c**surfaces for c in colour], thickness) if min(colour) < 0.999 else [0.0] * 3
    if any(coefficient):
        values.notes.append(
            f"{values.label}: its colour became absorption over its mean thickness of {1000 * thickness:.1f} mm"
        )
    volume = volume_node(material)
    if volume is not None and volume.type == "VOLUME_ABSORPTION":
        inside = Values(volume, values.label, values.notes)
        density, tint = inside.get("Density", 1.0), clamped(inside.get("Color", (1, 1, 1)))
        coefficient = [c + density * (1.0 - t) for c, t in zip(coefficient, tint)]
    elif volume is not None:
        values.notes.append(f"{values.label}: the volume '{volume.name}' is left out; Absorption is read")
    glass = {"type": "glass", "ior": min(max(values.get("IOR", 1.45), 1.0), 4.0)}
    return {**glass, "absorption": coefficient} if any(coefficient) else glass


def material_of(material, label, thickness, notes):
    """A Blender material as Lightloom's: glass, mirror or matt."""
    node = surface_node(material)
    values = Values(node, label, notes)
    kind = node.type if node else None

    def polished(what):
        roughness = values.get("Roughness", 0.0)
        if roughness > POLISHED:
            notes.append(f"{label}: {what} of roughness {roughness:.2f} is taken as polished")

    if kind in ("BSDF_GLASS", "BSDF_REFRACTION"):
        polished("glass")
        return glass_of(values, 2, material, thickness)
    if kind == "BSDF_PRINCIPLED":
        if values.get("Transmission Weight", 0.0) > MOSTLY:
            polished("glass")
            return glass_of(values, 1, material, thickness)
        if values.get("Metallic", 0.0) > MOSTLY and values.get("Roughness", 0.5) <= 0.2:
            polished("metal")
            return {"type": "mirror", "reflectance": clamped(values.get("Base Color", (0.8,) * 3))}
        if values.get("Emission Strength", 0.0) > 0 and max(list(values.get("Emission Color", (0,) * 4))[:3]) > 0:
            notes.append(f"{label}: its own glow is left out; give it a lamp")
        return {"type": "diffuse", "albedo": clamped(values.get("Base Color", (0.8,) * 3))}
    if kind in ("BSDF_GLOSSY", "BSDF_METALLIC"):
        polished("metal")
        name = "Color" if kind == "BSDF_GLOSSY" else "Base Color"
        return {"type": "mirror", "reflectance": clamped(values.get(name, (0.8,) * 3))}
    if kind == "BSDF_DIFFUSE":
        return {"type": "diffuse", "albedo": clamped(values.get("Color", (0.8,) * 3))}
    if kind is not None:
        notes.append(f"{label}: the shader '{node.name}' is not known; taken as matt")
    return {"type": "diffuse", "albedo": clamped(material.diffuse_color) if material else [0.8] * 3}


# ------------------------------------------------------------------------------------------------------- meshes


class Geometry:
    """An evaluated mesh in Lightloom's space: positions and corner normals, and triangles by material."""

    def __init__(self, mesh, matrix):
        mesh.calc_loop_triangles()
        count, corners, triangles = len(mesh.vertices), len(mesh.loops), len(mesh.loop_triangles)
        self.positions = np.empty(3 * count, np.float32)
        mesh.vertices.foreach_get("co", self.positions)
        normals = np.empty(3 * corners, np.float32)
        mesh.corner_normals.foreach_get("vector", normals)
        self.triangles, self.corners = np.empty(3 * triangles, np.int32), np.empty(3 * triangles, np.int32)
        mesh.loop_triangles.foreach_get("vertices", self.triangles)
        mesh.loop_triangles.foreach_get("loops", self.corners)
        self.material = np.empty(triangles, np.int32)
        mesh.loop_triangles.foreach_get("material_index", self.material)
        world = np.array(matrix, np.float64)
        turn = np.array([[1, 0, 0], [0, 0, 1], [0, -1, 0]], np.float64)
        linear = turn @ world[:3, :3]
        self.positions = self.positions.reshape(-1, 3) @ linear.T + turn @ world[:3, 3]
        self.mirrored = np.linalg.det(linear) < 0
        # Normals go by the inverse transpose.
        self.normals = normals.reshape(-1, 3) @ np.linalg.pinv(linear)
        length = np.linalg.norm(self.normals, axis=1, keepdims=True)
        self.normals /= np.where(length > 0, length, 1)
        self.triangles, self.corners = self.triangles.reshape(-1, 3), self.corners.reshape(-1, 3)
        if self.mirrored:
            self.triangles, self.corners = self.triangles[:, ::-1], self.corners[:, ::-1]

    def mean_thickness(self):
        """The mean way through the body (m): 4 volumes over surface, exact for convex ones."""
        a, b, c = (self.positions[self.triangles[:, i]] for i in range(3))
        cross = np.cross(b - a, c - a)
        area = np.linalg.norm(cross, axis=1).sum() / 2
        volume = abs(np.einsum("ij,ij->i", a - self.positions.mean(0), cross).sum() / 6)
        return max(4 * volume / area, 1e-6) if area > 0 else 1.0

    def write(self, path, of_material):
        """Writes the triangles of one material slot as OBJ; false where there is none."""
        taken = self.material == of_material
        if not taken.any():
            return False
        vertices, vertex = np.unique(self.triangles[taken], return_inverse=True)
        corners, corner = np.unique(self.corners[taken], return_inverse=True)
        pairs = np.stack([vertex.reshape(-1), corner.reshape(-1)], 1).reshape(-1, 6) + 1
        with open(path + ".part", "w", encoding="ascii", newline="\n") as file:
            file.write("# Metres, Y up.\n")
            np.savetxt(file, self.positions[vertices], "v %.8g %.8g %.8g")
            np.savetxt(file, self.normals[corners], "vn %.6f %.6f %.6f")
            np.savetxt(file, pairs, "f %d//%d %d//%d %d//%d")
        os.replace(path + ".part", path)
        return True


def file_name(name, taken):
    """A plain file name, each once."""
    plain = re.sub(r"[^A-Za-z0-9_-]+", "_", name) or "mesh"
    unique, number = plain, 2
    while unique.lower() in taken:
        unique, number = f"{plain}_{number}", number + 1
    taken.add(unique.lower())
    return unique


def unique_name(name, taken):
    unique, number = name, 2
    while unique in taken:
        unique, number = f"{name} {number}", number + 1
    taken.add(unique)
    return unique


# ----------------------------------------------------------------------------------------------------- receiver


def plane_frame(obj, mesh):
    """Centre, unit axes of width and height, and size (m) of a flat rectangular object; none for another."""
    points = [obj.matrix_world @ vertex.co for vertex in mesh.vertices]
    turn = obj.matrix_world.to_3x3()
    right, up = turn.col[0].normalized(), turn.col[1].normalized()
    normal = right.cross(up)
    if len(points) < 4 or normal.length < 0.999:
        return None
    along = [[p.dot(axis) for p in points] for axis in (right, up, normal)]
    size = [max(values) - min(values) for values in along]
    if min(size[:2]) <= 0 or size[2] > FLAT * max(size[:2]):
        return None
    middle = [(max(values) + min(values)) / 2 for values in along]
    centre = right * middle[0] + up * middle[1] + normal * middle[2]
    return centre, right, up, size[:2]


def receiver_of(context, objects, depsgraph):
    """The receiver: the active object where it is a plane, that named 'Receiver', or the largest plane."""
    planes = []
    for obj in objects:
        evaluated = obj.evaluated_get(depsgraph)
        mesh = evaluated.to_mesh()
        frame = plane_frame(evaluated, mesh)
        evaluated.to_mesh_clear()
        if frame:
            planes.append((obj, frame))
    active = context.view_layer.objects.active
    for wanted in (lambda o: o == active, lambda o: o.name == RECEIVER):
        for obj, frame in planes:
            if wanted(obj):
                return obj, frame
    glassy = lambda o: any(material_of(s.material, "", 1, [])["type"] == "glass" for s in o.material_slots)
    planes = [plane for plane in planes if not glassy(plane[0])]
    return max(planes, key=lambda plane: plane[1][3][0] * plane[1][3][1], default=None)


def receiver_desc(frame, albedo):
    """The receiver of the project: Lightloom turns it about the x, then y, then z axis."""
    centre, right, up, size = frame
    x, depth = Vector(y_up(right)), -Vector(y_up(up))
    normal = depth.cross(x)
    # The columns of the rotation matrix are the turned axes.
    rotate = [math.atan2(normal[2], depth[2]), -math.asin(max(-1.0, min(1.0, x[2]))), math.atan2(x[1], x[0])]
    if abs(x[2]) > 1 - 1e-9:
        rotate = [math.atan2(-depth[1], normal[1]), rotate[1], 0.0]
    degrees = [round(math.degrees(a), 5) + 0.0 for a in rotate]
    return {"centre": y_up(centre), "size": size, "rotate": degrees, "albedo": albedo}


# ----------------------------------------------------------------------------------------------- lamps and camera


def softened(lamp, distance):
    """The share of its light that a lamp with soft falloff has at a distance: Cycles draws it as a disk that faces the point."""
    radius = lamp.shadow_soft_size if getattr(lamp, "use_soft_falloff", False) else 0.0
    return distance**2 / (distance**2 + radius**2) if radius > 0 else 1.0


def light_of(obj, receiver, notes):
    """A lamp in Lightloom's terms; `receiver` is the middle of the plane, for which a soft falloff is right."""
    lamp, matrix = obj.data, obj.matrix_world
    position, ahead = matrix.translation, -matrix.col[2].xyz.normalized()
    colour = Vector(lamp.color)
    if getattr(lamp, "use_temperature", False):
        colour = Vector(a * b for a, b in zip(colour, lamp.temperature_color))
    power = lamp.energy * 2.0 ** getattr(lamp, "exposure", 0.0)
    light = {"name": obj.name, "colour": list(colour)}
    placed = {"position": y_up(position), "target": point_ahead(position, ahead)}
    note = lambda text: notes.append(f"{obj.name}: {text}")
    if lamp.use_nodes and lamp.node_tree:
        strength = next((n for n in lamp.node_tree.nodes if n.type == "EMISSION"), None)
        if strength and (strength.inputs["Strength"].is_linked or strength.inputs["Color"].is_linked):
            note("its nodes are left out")
        elif strength:
            power *= strength.inputs["Strength"].default_value
            light["colour"] = [a * b for a, b in zip(colour, strength.inputs["Color"].default_value)]
    if lamp.type == "SUN":
        # Blender's strength of a sun is the irradiance of a surface that faces it.
        return {"type": "directional", **light, "irradiance": power, "direction": y_up(ahead), "angle_deg": math.degrees(lamp.angle)}
    if not getattr(lamp, "normalize", True):
        note("its power is taken as that of the whole lamp ('Normalize' is off)")
    if lamp.type in ("POINT", "SPOT"):
        power *= softened(lamp, (position - receiver).length)
    if lamp.type == "POINT":
        if lamp.shadow_soft_size > 0:
            return {"type": "sphere", **light, "watts": power, "position": placed["position"], "radius": lamp.shadow_soft_size}
        return {"type": "point", **light, "watts": power, "position": placed["position"]}
    if lamp.type == "SPOT":
        if lamp.shadow_soft_size > 0:
            note(f"a spot is a point here; its radius of {lamp.shadow_soft_size:.3g} m is left out")
        if lamp.use_square:
            note("its square cone is taken as round")
        # Blender's watts are those of the lamp without its cone; its blend falls off in the cosine.
        half = lamp.spot_size / 2
        outer = 1 - math.cos(half)
        inner = outer * (1 - lamp.spot_blend)
        return {
            "type": "spot", **light, **placed, "watts": power * (inner + outer) / 4,
            "angle_deg": math.degrees(lamp.spot_size), "soft_edge": 1 - math.acos(1 - inner) / half,
        }
    return {"type": "rectangle", **light, **placed, **area_of(lamp, matrix, power, note)}


def area_of(lamp, matrix, power, note):
    """Size and watts of a panel; round ones become squares of the same area."""
    scale = matrix.to_scale()
    width = lamp.size * scale.x
    height = (lamp.size_y if lamp.shape in ("RECTANGLE", "ELLIPSE") else lamp.size) * scale.y
    # Lightloom lays the width of a panel horizontal, and that of one which looks straight down along x.
    level = matrix.col[2].xyz.normalized().cross(Vector((0, 0, 1)))
    level = level.normalized() if level.length > VERTICAL else Vector((1, 0, 0))
    along = abs(matrix.col[0].xyz.normalized().dot(level))
    if along < 0.03:
        width, height = height, width
    elif along < 0.999 and (abs(width - height) > 1e-6 or lamp.shape in ("SQUARE", "RECTANGLE")):
        note("the roll of the panel is left out")
    if lamp.shape in ("DISK", "ELLIPSE"):
        note("its round shape is taken as a rectangle of the same area")
        width, height = (side * math.sqrt(math.pi) / 2 for side in (width, height))
    if lamp.spread < math.pi - 1e-3:
        note("its spread is left out: it shines to its whole side")
    return {"watts": power, "size": [width, height]}


def picture_size(scene):
    render = scene.render
    share = render.resolution_percentage / 100
    return [max(int(n * share), 1) for n in (render.resolution_x, render.resolution_y)]


def camera_of(obj, scene, notes):
    """The camera of the project: vertical field of view by the sensor fit, and lens shift in shares of the picture."""
    camera, matrix = obj.data, obj.matrix_world
    width, height = picture_size(scene)
    if camera.type != "PERSP":
        notes.append(f"{obj.name}: a camera of kind {camera.type} is taken as one with perspective")
    if camera.dof.use_dof:
        notes.append(f"{obj.name}: depth of field is left out")
    if abs(scene.render.pixel_aspect_x - scene.render.pixel_aspect_y) > 1e-6:
        notes.append("pixels that are not square are taken as square")
    fit = camera.sensor_fit
    if fit == "AUTO":
        fit = "HORIZONTAL" if width >= height else "VERTICAL"
        sensor = camera.sensor_width
    else:
        sensor = camera.sensor_width if fit == "HORIZONTAL" else camera.sensor_height
    # Shift is in shares of the side that the sensor is fitted to.
    fitted = width if fit == "HORIZONTAL" else height
    tangent = sensor / 2 / camera.lens * height / fitted
    ahead, up = -matrix.col[2].xyz.normalized(), matrix.col[1].xyz.normalized()
    return {
        "position": y_up(matrix.translation), "look_at": point_ahead(matrix.translation, ahead), "up": y_up(up),
        "fov_deg": math.degrees(2 * math.atan(tangent)),
        "shift": [camera.shift_x * fitted / width + 0.0, camera.shift_y * fitted / height + 0.0],
    }


def environment_of(world, notes):
    """An even sky of the world's background colour."""
    node = next((n for n in world.node_tree.nodes if n.type == "BACKGROUND"), None) if world and world.node_tree else None
    if node is None:
        return None
    if node.inputs["Color"].is_linked:
        notes.append("the world's texture is left out; its light casts no caustics")
        return None
    colour = [c * node.inputs["Strength"].default_value for c in list(node.inputs["Color"].default_value)[:3]]
    return {"zenith": colour, "horizon": colour, "ground": colour}


# ------------------------------------------------------------------------------------------------------- export


def visible_objects(context):
    return [o for o in context.scene.objects if not o.hide_render and o.visible_get(view_layer=context.view_layer)]


def meshes_of(depsgraph, receiver, folder, assets, notes):
    """Writes all meshes, instances and modifiers included, and returns their descriptions."""
    descriptions, files, names = [], set(), set()
    for instance in depsgraph.object_instances:
        obj = instance.object
        original = (instance.parent or obj).original if instance.is_instance else obj.original
        if obj.type not in ("MESH", "CURVE", "SURFACE", "FONT", "META") or original.hide_render:
            continue
        if obj.original == receiver or not instance.show_self:
            continue
        try:
            mesh = obj.to_mesh()
        except RuntimeError:
            continue
        if mesh is None or not len(mesh.polygons):
            obj.to_mesh_clear()
            continue
        geometry = Geometry(mesh, instance.matrix_world)
        slots = [slot.material for slot in obj.material_slots] or [None]
        thickness = geometry.mean_thickness()
        for index, material in enumerate(slots):
            label = obj.name if len(slots) == 1 or material is None else f"{obj.name} {material.name}"
            name = file_name(label, files)
            path = os.path.join(folder, assets, name + ".obj")
            last = index == len(slots) - 1
            if last:
                geometry.material = np.minimum(geometry.material, index)
            if geometry.write(path, index):
                descriptions.append({
                    "name": unique_name(label, names),
                    "file": f"{assets}/{name}.obj",
                    "material": material_of(material, label, thickness, notes),
                })
        obj.to_mesh_clear()
        if original.animation_data and original.animation_data.action:
            notes.append(f"{original.name}: moves; it stands as in frame {depsgraph.scene.frame_current}")
    return descriptions


def export(context, path):
    """Writes the project `path` and its meshes beside it; returns what was left out or changed, in words.

    Raises ValueError for a scene without a camera or a plane to receive the light, and OSError.
    """
    scene, notes = context.scene, []
    if scene.camera is None:
        raise ValueError("the scene has no camera; add one (Add > Camera)")
    depsgraph = context.evaluated_depsgraph_get()
    objects = visible_objects(context)
    found = receiver_of(context, [o for o in objects if o.type == "MESH"], depsgraph)
    if found is None:
        raise ValueError(f"no plane receives the light; add one, and select it or name it '{RECEIVER}'")
    receiver, frame = found
    material = next((slot.material for slot in receiver.material_slots), None)
    matt = material_of(material, receiver.name, 1.0, notes)
    notes.append(f"{receiver.name}: it receives the light")
    folder, stem = os.path.split(os.path.abspath(path))
    stem = os.path.splitext(stem)[0]
    assets = file_name(stem, set()) + "_meshes"
    os.makedirs(os.path.join(folder, assets), exist_ok=True)
    described = {
        "meshes": meshes_of(depsgraph, receiver, folder, assets, notes),
        "lights": [light_of(o, frame[0], notes) for o in objects if o.type == "LIGHT"],
        "camera": camera_of(scene.camera, scene, notes),
        "receiver": receiver_desc(frame, matt.get("albedo", [0.8] * 3)),
    }
    environment = environment_of(scene.world, notes)
    if environment:
        described["environment"] = environment
    width, height = picture_size(scene)
    ends = sorted({scene.frame_start, scene.frame_end})
    rate = (round(scene.render.fps * 1000), round(scene.render.fps_base * 1000))
    shared = math.gcd(*rate)
    project = {
        "lightloom": 1,
        "name": stem,
        "scene": described,
        "keys": [{"frame": frame, "shows": "physical_caustic"} for frame in ends],
        "render": {"width": width, "height": height},
        "output": {"name": f"{file_name(stem, set())}.####", "fps": [n // shared for n in rate]},
    }
    if not any(mesh["material"]["type"] != "diffuse" for mesh in described["meshes"]):
        notes.append("no glass and no mirror: nothing casts a caustic")
    if not described["lights"]:
        notes.append("no lamp: there is no light")
    with open(path + ".part", "w", encoding="utf-8", newline="\n") as file:
        json.dump(project, file, indent=2, ensure_ascii=False)
        file.write("\n")
    os.replace(path + ".part", path)
    return list(dict.fromkeys(notes))


# ------------------------------------------------------------------------------------------------------- import


def sequence_of(path):
    """The frames of a sequence by the name of one of them, `name.0012.exr`: first and last number."""
    folder, name = os.path.split(os.path.abspath(path))
    match = re.fullmatch(r"(.*?)(-?\d+)(\.exr)", name, re.IGNORECASE)
    if match is None:
        return None
    same = re.compile(re.escape(match[1]) + r"(-?\d+)" + re.escape(match[3]), re.IGNORECASE)
    numbers = [int(found[1]) for found in map(same.fullmatch, os.listdir(folder)) if found]
    return (min(numbers), max(numbers)) if numbers else None


def compositing_tree(scene):
    """The scene's compositing nodes: a group of its own since Blender 5."""
    if hasattr(scene, "compositing_node_group"):
        if scene.compositing_node_group is None:
            tree = bpy.data.node_groups.new("Compositing", "CompositorNodeTree")
            tree.interface.new_socket("Image", in_out="OUTPUT", socket_type="NodeSocketColor")
            scene.compositing_node_group = tree
        return scene.compositing_node_group
    scene.use_nodes = True
    return scene.node_tree


def output_node(tree):
    kinds = ("GROUP_OUTPUT", "COMPOSITE")
    node = next((n for n in tree.nodes if n.type in kinds), None)
    if node is None:
        node = tree.nodes.new("NodeGroupOutput" if tree.bl_idname == "CompositorNodeTree" and bpy.app.version >= (5, 0) else "CompositorNodeComposite")
    return node


def adding_node(tree):
    """A node that adds two pictures, with its two inputs and its output."""
    if bpy.app.version >= (5, 0):
        node = tree.nodes.new("ShaderNodeMix")
        node.data_type, node.blend_type = "RGBA", "ADD"
        node.clamp_factor, node.clamp_result = False, False
        colours = [s for s in node.inputs if s.type == "RGBA"]
        node.inputs[0].default_value = 1.0
        return node, colours, next(s for s in node.outputs if s.type == "RGBA")
    node = tree.nodes.new("CompositorNodeMixRGB")
    node.blend_type = "ADD"
    node.inputs[0].default_value = 1.0
    return node, [node.inputs[1], node.inputs[2]], node.outputs[0]


def load_layer(context, path, clear_caustics=True):
    """Adds the caustic of rendered frames to the picture in the compositor; `path` is one of them.

    With `clear_caustics` Cycles leaves its own caustics out, which would be there twice. Raises ValueError for a file that is
    no frame of a sequence.
    """
    scene = context.scene
    frames = sequence_of(path)
    if frames is None:
        raise ValueError(f"'{os.path.basename(path)}' is no frame of a sequence such as caustic.0001.exr")
    tree = compositing_tree(scene)
    picture = bpy.data.images.load(path, check_existing=False)
    picture.source = "SEQUENCE"
    node = tree.nodes.new("CompositorNodeImage")
    node.image, node.label, node.name = picture, "Lightloom caustic", "Lightloom caustic"
    node.frame_start, node.frame_offset, node.frame_duration = frames[0], frames[0] - 1, frames[1] - frames[0] + 1
    node.use_auto_refresh = True
    output = output_node(tree)
    target = output.inputs.get("Image") or output.inputs[0]
    before = target.links[0].from_socket if target.is_linked else None
    if before is None:
        before = tree.nodes.new("CompositorNodeRLayers").outputs["Image"]
    add, colours, result = adding_node(tree)
    add.label = "Add caustic"
    tree.links.new(before, colours[0])
    tree.links.new(caustic_socket(node), colours[1])
    tree.links.new(result, target)
    node.location, add.location = (before.node.location.x, before.node.location.y - 400), (before.node.location.x + 300, before.node.location.y)
    output.location = (add.location.x + 250, add.location.y)
    scene.render.use_compositing = True
    if clear_caustics and hasattr(scene, "cycles"):
        scene.cycles.caustics_reflective = scene.cycles.caustics_refractive = False
    return node


def caustic_socket(node):
    """The output of an image node that holds the caustic alone."""
    return next((s for s in node.outputs if s.name.lower() == "caustic"), node.outputs[0])


# ------------------------------------------------------------------------------------------------------- window


class EXPORT_SCENE_OT_lightloom(bpy.types.Operator, ExportHelper):
    """Write the scene as a Lightloom project: meshes, glass, lamps, camera, receiver and frame range"""

    bl_idname = "export_scene.lightloom"
    bl_label = "Export Lightloom"
    filename_ext = ".json"
    filter_glob: StringProperty(default="*.json", options={"HIDDEN"})

    def execute(self, context):
        try:
            notes = export(context, self.filepath)
        except (ValueError, OSError) as error:
            self.report({"ERROR"}, f"Lightloom: {error}")
            return {"CANCELLED"}
        for note in notes:
            self.report({"INFO"}, f"Lightloom: {note}")
        self.report({"INFO"}, f"Lightloom: wrote {self.filepath}")
        return {"FINISHED"}


class IMPORT_IMAGE_OT_lightloom(bpy.types.Operator, ImportHelper):
    """Add the caustic of frames rendered by Lightloom to the picture, in the compositor"""

    bl_idname = "import_image.lightloom"
    bl_label = "Import Lightloom caustic layer"
    filename_ext = ".exr"
    filter_glob: StringProperty(default="*.exr", options={"HIDDEN"})
    clear_caustics: BoolProperty(
        name="No caustics by Cycles", description="Leave out Cycles' own caustics, which would be there twice", default=True
    )

    def execute(self, context):
        try:
            load_layer(context, self.filepath, self.clear_caustics)
        except (ValueError, OSError, RuntimeError) as error:
            self.report({"ERROR"}, f"Lightloom: {error}")
            return {"CANCELLED"}
        return {"FINISHED"}


def export_entry(menu, _context):
    menu.layout.operator(EXPORT_SCENE_OT_lightloom.bl_idname, text="Lightloom (.json)")


def import_entry(menu, _context):
    menu.layout.operator(IMPORT_IMAGE_OT_lightloom.bl_idname, text="Lightloom caustic layer (.exr)")


CLASSES = (EXPORT_SCENE_OT_lightloom, IMPORT_IMAGE_OT_lightloom)


def register():
    for each in CLASSES:
        bpy.utils.register_class(each)
    bpy.types.TOPBAR_MT_file_export.append(export_entry)
    bpy.types.TOPBAR_MT_file_import.append(import_entry)


def unregister():
    bpy.types.TOPBAR_MT_file_import.remove(import_entry)
    bpy.types.TOPBAR_MT_file_export.remove(export_entry)
    for each in reversed(CLASSES):
        bpy.utils.unregister_class(each)


if __name__ == "__main__":
    register()
