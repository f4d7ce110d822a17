# SPDX-License-Identifier: Apache-2.0
"""How Blender's World is turned against vmlight's environments. Angles are in degrees unless a name says radians.

A rotation is three rows of three floats, for column vectors. Two frames differ:

- Space: Blender has z up, vmlight y up. A map is baked of the mesh as glTF turns it: (x, y, z) becomes (x, z, -y).
- Lat-long maps: Blender has its +x at the centre and its -y at three quarters of the width; vmlight has its +z at the
  centre and its -x there. So what Blender looks up along (x, y, z), vmlight finds along (y, z, x).

Together they are a turn of -90 degrees about y: a World whose Mapping has a Z rotation of 90 degrees lights as vmlight
does without a rotation.
"""
import math

IDENTITY = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))
SPACE_TO_OURS = ((1.0, 0.0, 0.0), (0.0, 0.0, 1.0), (0.0, -1.0, 0.0))
MAP_TO_OURS = ((0.0, 1.0, 0.0), (0.0, 0.0, 1.0), (1.0, 0.0, 0.0))

# How far the rows of a Mapping node or of an object's matrix may be from a rotation.
TOLERANCE = 1e-4


def multiply(a, b):
    return tuple(tuple(sum(a[i][k] * b[k][j] for k in range(3)) for j in range(3)) for i in range(3))


def transposed(a):
    return tuple(zip(*a))


def apply(a, vector):
    return tuple(sum(row[k] * vector[k] for k in range(3)) for row in a)


def _sin_cos(degrees):
    """Exact at quarter turns, as vmlight's own."""
    turn = math.remainder(degrees, 360)
    quarters = round(turn / 90)
    rest = math.radians(turn - 90 * quarters)
    s, c = math.sin(rest), math.cos(rest)
    return ((s, c), (c, -s), (-s, -c), (-c, s))[quarters % 4]


def from_angles(x, y, z):
    """About the fixed axes x, then y, then z: vmlight's `rotate`, and Blender's Euler angles of order XYZ."""
    (a, b), (c, d), (e, f) = _sin_cos(x), _sin_cos(y), _sin_cos(z)
    return multiply(((f, -e, 0), (e, f, 0), (0, 0, 1)),
                    multiply(((d, 0, c), (0, 1, 0), (-c, 0, d)), ((1, 0, 0), (0, b, -a), (0, a, b))))


def to_angles(rotation):
    """(x, y, z) for which from_angles() gives the rotation; z is 0 where y is a quarter turn and leaves it open."""
    (r00, r01, r02), (r10, r11, r12), (r20, r21, r22) = rotation
    flat = math.hypot(r00, r10)
    y = math.atan2(-r20, flat)
    if flat > 1e-7:
        x, z = math.atan2(r21, r22), math.atan2(r10, r00)
    else:
        x, z = math.atan2(-r12, r11), 0.0
    return tuple(math.degrees(angle) + 0.0 for angle in (x, y, z))


def from_quaternion(w, x, y, z):
    length = math.sqrt(w * w + x * x + y * y + z * z)
    w, x, y, z = w / length, x / length, y / length, z / length
    return ((1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)),
            (2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)),
            (2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)))


def mapping_fault(kind, location, scale):
    """Why a Mapping node is no rotation, or "". `kind` is its vector_type."""
    if kind in ("POINT", "TEXTURE") and max(map(abs, location)) > TOLERANCE:
        return f"its Mapping node moves the map by {_numbers(location)}: set Location to 0"
    if max(scale) - min(scale) > TOLERANCE * max(map(abs, scale)) or min(scale) <= 0:
        return f"its Mapping node scales the map by {_numbers(scale)}: set Scale to 1"
    return ""


def mapping_rotation(kind, radians):
    """What a Mapping node does to directions: `kind` TEXTURE is the inverse of POINT, VECTOR and NORMAL."""
    rotation = from_angles(*(_degrees(angle) for angle in radians))
    return transposed(rotation) if kind == "TEXTURE" else rotation


def _degrees(radians):
    """Blender keeps radians as floats: what a user typed as 90 is 90 again."""
    degrees = math.degrees(radians)
    nearest = round(degrees, 3)
    return nearest if abs(degrees - nearest) < 2e-7 * max(abs(degrees), 90) else degrees


def rotate_for_vmlight(world_mapping=IDENTITY, turn_since_bake=IDENTITY):
    """The angles of --rotate with which a map that was baked in Blender's space sees Blender's World.

    @param world_mapping: what is done to a direction before the map is looked up, in Blender's axes
    @param turn_since_bake: how the object was turned since, in Blender's axes
    """
    to_world = multiply(turn_since_bake, transposed(SPACE_TO_OURS))
    return tuple(_tidy(angle) for angle in to_angles(multiply(MAP_TO_OURS, multiply(world_mapping, to_world))))


def inverse_angles(angles):
    """The angles of the inverse of a rotation: --env-rotate, for what --rotate does to the light."""
    return tuple(_tidy(angle) for angle in to_angles(transposed(from_angles(*angles))))


def _tidy(degrees):
    """Without what rounding leaves behind; below 1e-9 degrees nothing shows in a float."""
    rounded = round(degrees, 9)
    return rounded + 0.0


def _numbers(values):
    return ", ".join(f"{value:.4g}" for value in values)
