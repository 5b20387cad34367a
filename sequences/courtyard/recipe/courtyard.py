"""The courtyard: panning camera, rolling ball, a swinging sign, columns,
lattice and sky.  blender -b --factory-startup --python courtyard.py -- out=DIR what=jit|ref|ss4|ss16"""
import bpy, math, os, sys
sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import render_common as C


def dims(o, x, y, z):
    for v in o.data.vertices:
        v.co.x *= x
        v.co.y *= y
        v.co.z *= z
    return o


def build(s):
    C.world((0.45, 0.62, 0.9), 0.7, sample=False, diffuse=False)
    s.cycles.diffuse_bounces = 0
    # soft sun: penumbra noise only
    C.light('sun', 'SUN', (0, 0, 6), (math.radians(38), math.radians(-22), 0), 3.0, math.radians(2.5),
            (1.0, 0.95, 0.85))
    stone = C.matte('stone', (0.62, 0.58, 0.5), 0.3, 'ShaderNodeTexNoise', 5.0, (0.42, 0.38, 0.33))
    tiles = C.matte('tiles', (0.66, 0.5, 0.4), 0.3, 'ShaderNodeTexChecker', 2.2, (0.42, 0.32, 0.3))
    wood = C.matte('wood', (0.32, 0.18, 0.09), 0.3)
    plaster = C.matte('plaster', (0.78, 0.72, 0.6), 0.3, 'ShaderNodeTexVoronoi', 1.6, (0.7, 0.62, 0.5))
    dims(C.plane('floor', 1, (0, 5, 0), mat=tiles, index=1), 30, 30, 1)
    dims(C.cube('back', (1, 1, 1), (0, 9, 1.6), mat=plaster, index=2), 18, 0.4, 3.2)
    dims(C.cube('left', (1, 1, 1), (-7, 5, 1.6), mat=plaster, index=2), 0.4, 9, 3.2)
    for k in range(7):
        C.rod('column', (-5.4 + 1.8 * k, 6.5, 0), (-5.4 + 1.8 * k, 6.5, 2.6), 0.17, stone, 3, 24)
    dims(C.cube('beam', (1, 1, 1), (0, 6.5, 2.75), mat=stone, index=3), 12, 0.5, 0.3)
    # lattice screen: thin slats
    for k in range(22):
        C.rod('slat', (1.4 + 0.12 * k, 3.2, 0.1), (1.4 + 0.12 * k, 3.2, 1.5), 0.011, wood, 4, 6)
    for k in range(8):
        C.rod('slat', (1.35, 3.2, 0.15 + 0.18 * k), (4.0, 3.2, 0.15 + 0.18 * k), 0.009, wood, 4, 6)
    # fountain bowl and water jets stand-in
    C.rod('bowl', (-1.6, 4.6, 0), (-1.6, 4.6, 0.45), 0.75, stone, 5, 40)
    C.sphere('orb', 0.3, (-1.6, 4.6, 0.85), C.mirror('orb', (0.9, 0.95, 1.0)), 5)
    lamp = C.glow('lamp', (1.0, 0.75, 0.4), 8.0)
    for k in range(4):
        C.sphere('lamp', 0.06, (-4.5 + 3.6 * k, 6.2, 2.2), lamp, 6)
    # rolling ball: travels right and spins
    ball = C.sphere('ball', 0.38, (0, 0, 0.38),
                    C.matte('ball', (0.85, 0.1, 0.08), 0.3, 'ShaderNodeTexChecker', 3.5, (0.95, 0.92, 0.85)), 7)
    C.keys(ball, 'location', [(f, (-2.6 + 0.16 * f, 2.0, 0.38)) for f in (-3, 25)])
    C.keys(ball, 'rotation_euler', [(f, (0, 0.16 * f / 0.38, 0)) for f in (-3, 25)])
    # hanging sign, swinging
    sign = dims(C.cube('sign', (1, 1, 1), (2.6, 5.9, 2.5),
                mat=C.matte('sign', (0.1, 0.25, 0.5), 0.4, 'ShaderNodeTexChecker', 8.0, (0.9, 0.85, 0.3)), index=8),
                0.8, 0.05, 0.5)
    for v in sign.data.vertices:
        v.co.z -= 0.4
    C.keys(sign, 'rotation_euler', [(f, (0, 0.45 * math.sin(0.4 * f), 0)) for f in range(-3, 25)])
    cam = C.camera('cam', (0, -3.5, 1.5), (0, 5, 1.2), lens=30)
    s.camera = cam

    def path(f):
        t = f - 1
        return (0.02 * t - 0.3, -3.6, 1.5), (-1.2 + 0.09 * t, 5, 1.25 + 0.01 * t)
    C.camera_path(cam, path, range(-1, 20))
    C.passes(s.view_layers[0])


C.main(build, '1-16', '9-16')
