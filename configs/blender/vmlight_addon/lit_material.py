# SPDX-License-Identifier: Apache-2.0
"""Shows an object's lit texture: each material slot gets a material that glows with it, times its base color.

Slots are switched to the object, so that neither the mesh nor the materials are touched, and Restore only switches back.
"""
import bpy

SHADER_COLORS = ("Base Color", "Color")
NOT_SURFACES = ("ShaderNodeEmission", "ShaderNodeBackground", "ShaderNodeBsdfTransparent", "ShaderNodeBsdfGlass")


def apply(ob, use_base_color):
    """Replaces what an earlier call made."""
    restore(ob)
    memory = ob.vmlight
    if not ob.material_slots:
        ob.data.materials.append(None)
        memory.added_slot = True
    for slot in ob.material_slots:
        before = memory.slots.add()
        before.link = slot.link
        old = slot.material
        if slot.link == "OBJECT":
            before.material = old
        lit = _lit_material(ob, old, use_base_color)
        slot.link = "OBJECT"
        slot.material = lit
    memory.applied = True


def restore(ob):
    """Brings back the materials before Apply. @returns whether there was something to bring back"""
    memory = ob.vmlight
    if not memory.applied:
        return False
    made = [slot.material for slot in ob.material_slots if slot.link == "OBJECT" and slot.material]
    for slot, before in zip(ob.material_slots, memory.slots):
        slot.material = before.material
        if before.link == "DATA":
            slot.link = "DATA"
    if memory.added_slot:
        # The mesh's slots are all its objects': the last one that is lit removes it.
        other = next((user for user in bpy.data.objects if user != ob and user.data == ob.data and user.vmlight.applied), None)
        if other:
            other.vmlight.added_slot = True
        else:
            ob.data.materials.clear()
    memory.slots.clear()
    memory.added_slot = memory.applied = False
    for material in made:
        if material.users == 0 and material.get("vmlight"):
            bpy.data.materials.remove(material)
    return True


def _lit_material(ob, old, use_base_color):
    if old and old.use_nodes:
        material = old.copy()
    else:
        material = bpy.data.materials.new("")
        material.use_nodes = True
        if old:
            material.diffuse_color = old.diffuse_color
    material.name = f"{old.name if old else ob.name} lit"
    material["vmlight"] = True
    if hasattr(material, "cycles") and hasattr(material.cycles, "emission_sampling"):
        material.cycles.emission_sampling = "NONE"
    elif hasattr(material, "cycles") and hasattr(material.cycles, "sample_as_light"):
        material.cycles.sample_as_light = False  # it shows light, and is no lamp
    tree = material.node_tree
    output = tree.get_output_node("ALL") or tree.get_output_node("CYCLES") or tree.nodes.new("ShaderNodeOutputMaterial")
    if not (old and old.use_nodes):
        for node in [node for node in tree.nodes if node != output]:
            tree.nodes.remove(node)
    shader = _shader(output)

    uv_map = tree.nodes.new("ShaderNodeUVMap")
    uv_map.uv_map = ob.vmlight.uv_map
    texture = tree.nodes.new("ShaderNodeTexImage")
    texture.image = ob.vmlight.image
    texture.label = "vmlight"
    emission = tree.nodes.new("ShaderNodeEmission")
    for node, step in ((uv_map, 800), (texture, 600), (emission, 200)):
        node.location = (output.location.x - step, output.location.y + 400)
    tree.links.new(uv_map.outputs["UV"], texture.inputs["Vector"])
    color = texture.outputs["Color"]
    if use_base_color:
        color = _times_base_color(tree, color, shader, old, emission.location)
    tree.links.new(color, emission.inputs["Color"])
    surface = emission.outputs[0]
    alpha = shader.inputs.get("Alpha") if shader else None
    if alpha and (alpha.is_linked or alpha.default_value < 1):
        surface = _cut_out(tree, surface, alpha, emission.location)
    tree.links.new(surface, output.inputs["Surface"])
    return material


def _shader(output):
    """The first node behind the output that has a base color."""
    waiting, seen = [output.inputs["Surface"]], set()
    while waiting:
        socket = waiting.pop(0)
        for link in socket.links:
            node = link.from_node
            if node in seen:
                continue
            seen.add(node)
            is_shader = node.bl_idname.startswith("ShaderNodeBsdf") and node.bl_idname not in NOT_SURFACES
            if is_shader and any(name in node.inputs for name in SHADER_COLORS):
                return node
            waiting += [inner for inner in node.inputs if inner.type in ("SHADER", "RGBA") or node.bl_idname == "NodeReroute"]
    return None


def _times_base_color(tree, color, shader, old, place):
    socket = next((shader.inputs[name] for name in SHADER_COLORS if name in shader.inputs), None) if shader else None
    if socket is None and (old is None or old.use_nodes):
        return color  # nothing says what the surface looks like: white
    # No MixRGB, which Blender 3.4 made legacy; a vector is not clamped.
    product = tree.nodes.new("ShaderNodeVectorMath")
    product.operation = "MULTIPLY"
    product.location = (place.x - 200, place.y)
    tree.links.new(color, product.inputs[0])
    if socket and socket.is_linked:
        tree.links.new(socket.links[0].from_socket, product.inputs[1])
    else:
        product.inputs[1].default_value = tuple(socket.default_value if socket else old.diffuse_color)[:3]
    return product.outputs[0]


def _cut_out(tree, surface, alpha, place):
    mix = tree.nodes.new("ShaderNodeMixShader")
    clear = tree.nodes.new("ShaderNodeBsdfTransparent")
    mix.location, clear.location = (place.x + 180, place.y), (place.x, place.y - 120)
    if alpha.is_linked:
        tree.links.new(alpha.links[0].from_socket, mix.inputs[0])
    else:
        mix.inputs[0].default_value = alpha.default_value
    tree.links.new(clear.outputs[0], mix.inputs[1])
    tree.links.new(surface, mix.inputs[2])
    return mix.outputs[0]
