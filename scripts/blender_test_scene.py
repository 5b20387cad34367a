"""A small scene for scripts/check_blender: textured walls at rest, a ball and a box that move, a camera that moves from
frame 6 on.  blender -b --factory-startup --python scripts/blender_test_scene.py -- FILE.blend"""
import math
import sys

import bpy


def textured(name, scale, one, other, kind='ShaderNodeTexChecker'):
    material = bpy.data.materials.new(name)
    material.use_nodes = True
    tree = material.node_tree
    place, texture = tree.nodes.new('ShaderNodeTexCoord'), tree.nodes.new(kind)
    texture.inputs['Scale'].default_value = scale
    tree.links.new(place.outputs['Object'], texture.inputs['Vector'])
    if kind == 'ShaderNodeTexChecker':
        texture.inputs['Color1'].default_value, texture.inputs['Color2'].default_value = one, other
        color = texture.outputs['Color']
    else:
        ramp = tree.nodes.new('ShaderNodeValToRGB')
        ramp.color_ramp.elements[0].position, ramp.color_ramp.elements[1].position = 0.45, 0.55
        ramp.color_ramp.elements[0].color, ramp.color_ramp.elements[1].color = one, other
        tree.links.new(texture.outputs['Distance' if 'Distance' in texture.outputs else 'Fac'], ramp.inputs['Fac'])
        color = ramp.outputs['Color']
    tree.links.new(color, tree.nodes['Principled BSDF'].inputs['Base Color'])
    return material


def add(kind, name, location, material, scale=(1, 1, 1), **more):
    getattr(bpy.ops.mesh, 'primitive_%s_add' % kind)(location=location, **more)
    thing = bpy.context.active_object
    thing.name, thing.scale = name, scale
    thing.data.materials.append(material)
    return thing


def key(thing, path, values):
    for frame, value in values:
        setattr(thing, path, value)
        thing.keyframe_insert(path, frame=frame)
    for curve in thing.animation_data.action.fcurves:
        for point in curve.keyframe_points:
            point.interpolation = 'LINEAR'


bpy.ops.wm.read_factory_settings(use_empty=True)
scene = bpy.context.scene
scene.render.engine = 'CYCLES'
scene.render.resolution_x, scene.render.resolution_y, scene.render.resolution_percentage = 160, 90, 100
scene.view_settings.view_transform = 'Standard'
scene.frame_start, scene.frame_end = 1, 10
scene.cycles.max_bounces = 1
scene.world = bpy.data.worlds.new('sky')
scene.world.color = (0.3, 0.4, 0.6)
add('plane', 'floor', (0, 4, 0), textured('tiles', 1.7, (0.6, 0.5, 0.4, 1), (0.3, 0.2, 0.2, 1)), (8, 8, 1), size=2)
add('cube', 'wall', (0, 8, 2), textured('cracks', 1.5, (0.2, 0.25, 0.3, 1), (0.8, 0.75, 0.6, 1), 'ShaderNodeTexVoronoi'),
    (8, 0.2, 2), size=2)
ball = add('uv_sphere', 'ball', (0, 3, 0.6), textured('ball', 4, (0.8, 0.1, 0.1, 1), (0.9, 0.9, 0.8, 1)), radius=0.6)
key(ball, 'location', [(0, (-2.0, 3, 0.6)), (12, (0.4, 3, 0.6))])
box = add('cube', 'box', (2, 4, 0.5), textured('box', 3, (0.1, 0.3, 0.6, 1), (0.8, 0.7, 0.2, 1)), size=1)
key(box, 'rotation_euler', [(0, (0, 0, 0)), (12, (0, 0, 1.2))])
sun = bpy.data.lights.new('sun', 'SUN')
sun.energy, sun.angle = 3, math.radians(1)
lamp = bpy.data.objects.new('sun', sun)
lamp.rotation_euler = (math.radians(40), math.radians(-25), 0)
scene.collection.objects.link(lamp)
camera = bpy.data.objects.new('camera', bpy.data.cameras.new('camera'))
camera.rotation_euler = (math.radians(80), 0, 0)
camera.data.lens = 32
scene.collection.objects.link(camera)
scene.camera = camera
key(camera, 'location', [(0, (0, -3, 1.6)), (5, (0, -3, 1.6)), (12, (0.7, -3, 1.7))])
bpy.ops.wm.save_as_mainfile(filepath=sys.argv[-1])
