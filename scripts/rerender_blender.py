"""Renders with Blender (3.4, Cycles) what `varve resolve --rerender LIST.json` asks for: crops, one sample each, for --extra.

  varve resolve render/frame.####.exr -o out/frame.####.exr --rerender list.json
  blender -b shot.blend --python scripts/rerender_blender.py -- list=list.json out=extra
  varve resolve render/frame.####.exr -o better/frame.####.exr --extra 'extra/extra.*.####.exr'

Give the file that scripts/blender_setup.py was given, not the one that it saved: the jitter must not be in it yet.
Options behind --, all of them name=value:
  list=FILE        as varve wrote it
  out=DIR          where the files go, under the names in the list; default //extra
  setup=FILE.py    a script that builds the scene; run first, with what=none as its only option
  color=half       or float, as the frames have it
  seed=9001        of the noise; sample k of a list has seed + k, so give another one for another list
  only=FRAMES      numbers and ranges with commas between; default all of the list
  full=no          yes renders whole frames and cuts nothing off, to see that crops are what they should be

Blender forgets where a crop was cut from; the note in the header tells it to varve, with the jitter.
"""
import json
import os
import sys

import bpy

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import blender_setup as setup  # noqa: E402


def options():
    known = dict(list='', out='//extra', setup='', color='half', seed='9001', only='', full='no')
    for item in sys.argv[sys.argv.index('--') + 1:] if '--' in sys.argv else []:
        name, equals, value = item.partition('=')
        if not equals or name not in known:
            setup.stop('there is no option "%s"; there are %s' % (item, ', '.join(k + '=' for k in known)))
        known[name] = value
    if not known['list']:
        setup.stop('list=FILE is missing: the file that varve resolve --rerender wrote')
    return known


def read_list(path):
    try:
        with open(path) as file:
            renders = json.load(file)
    except (OSError, ValueError) as problem:
        setup.stop('list=%s: cannot be read (%s)' % (path, problem))
    if renders.get('format') != 'varve rerender list' or renders.get('schema') != 1:
        setup.stop('list=%s: is no list of varve that this script knows' % path)
    return renders


def build(path):
    """Runs the script of a scene as if it stood alone, but without rendering."""
    sys.argv = ['blender', '--', 'what=none']
    with open(path) as file:
        code = compile(file.read(), path, 'exec')
    exec(code, {'__name__': '__main__', '__file__': os.path.abspath(path)})


def shifts_of(scene, frames):
    """The shift of each frame's camera without jitter; afterwards no camera has a curve that would set it again."""
    shifts = {}
    for f in frames:
        scene.frame_set(f)
        shifts[f] = (scene.camera.data.shift_x, scene.camera.data.shift_y)
    for camera in bpy.data.cameras:
        if camera.animation_data and camera.animation_data.action:
            curves = camera.animation_data.action.fcurves
            for curve in [c for c in curves if c.data_path in ('shift_x', 'shift_y')]:
                curves.remove(curve)
    return shifts


def set_border(scene, entry, full):
    x0, y0, x1, y1 = entry['window']
    width, height = setup.image_size(scene)
    r = scene.render
    r.use_border = r.use_crop_to_border = not full
    # Blender cuts fractions of pixels off: a quarter pixel more keeps its rounding away from the edge of the next one.
    r.border_min_x, r.border_max_x = (x0 + 0.25) / width, (x1 + 0.25) / width
    r.border_min_y, r.border_max_y = (height - y1 + 0.25) / height, (height - y0 + 0.25) / height


def main():
    o = options()
    wanted = read_list(o['list'])
    if o['setup']:
        build(o['setup'])
    scene = bpy.context.scene
    if setup.image_size(scene) != (wanted['width'], wanted['height']):
        setup.stop('the scene has %dx%d pixels, the list %dx%d' %
                   (*setup.image_size(scene), wanted['width'], wanted['height']))
    renders = wanted['renders']
    if o['only']:
        chosen = setup.frames_of(o['only'], scene)
        renders = [entry for entry in renders if entry['frame'] in chosen]
    settings = dict(color=o['color'], samples='1')
    setup.set_up_scene(scene, settings)
    setup.set_up_layers(scene, False)
    scene.render.use_persistent_data = True
    shifts = shifts_of(scene, sorted({entry['frame'] for entry in renders}))
    folder = bpy.path.abspath(o['out'])
    os.makedirs(folder, exist_ok=True)
    full = o['full'] == 'yes'
    for entry in renders:
        f = entry['frame']
        scene.frame_set(f)
        camera = scene.camera.data
        px, py = setup.pixel_in_shift(scene, camera)
        set_border(scene, entry, full)
        for k, ((jx, jy), name) in enumerate(zip(entry['jitter'], entry['files'])):
            scene.cycles.seed = int(o['seed']) + k
            camera.shift_x, camera.shift_y = shifts[f][0] + jx * px, shifts[f][1] + jy * py
            note = json.loads(setup.note_of(scene, f, (jx, jy), 1))
            if not full:
                note['window'] = entry['window']
            scene.render.stamp_note_text = json.dumps(note, separators=(',', ':'))
            scene.render.filepath = os.path.join(folder, name)
            bpy.ops.render.render(write_still=True)
        print('rerender_blender: frame %d, rectangle %d: %d samples of %s' %
              (f, entry['rectangle'], entry['samples'], entry['window']), flush=True)


try:
    main()
except Exception as problem:  # background mode would go on and end with 0
    setup.stop('%s: %s' % (type(problem).__name__, problem))
