"""Sets a scene of Blender (3.4, Cycles) up for `varve resolve`, and renders it. No add-on; nothing else to install.

  varve jitter halton23:16 --count 100 -o jitter.csv
  blender -b shot.blend --python scripts/blender_setup.py -- out=render frames=1-100 jitter=jitter.csv
  varve resolve render/frame.####.exr -o out/frame.####.exr --preset high

Options behind --, all of them name=value:
  out=DIR          frames go to DIR/frame.####.exr, the offsets that were used to DIR/jitter.csv; default //render
  frames=1-16      numbers and ranges with commas between; default the range of the scene
  jitter=FILE      as `varve jitter` writes it (columns frame,jx,jy); halton (default): Halton(2,3), 16 points; none
  samples=1        per pixel and frame; all of them at the same place of the pixel, so more of them lower noise only
  color=half       or float; vectors, depth, normals and ids are 32-bit floats in any case
  cryptomatte=no   yes adds the Cryptomatte of objects
  save=FILE        also save the scene as it was set up; a farm can render that (without the cameras in the headers)
  render=yes       no: set up and save only

What is set, and why (measured with Blender 3.4.1):
  passes Combined, Z, Vector, Normal, Object Index in every view layer that renders; objects without a pass index get one
  the jitter is a keyed shift of the camera: the Vector pass does not contain it, as it should be
  one sample at the place the shift says: at one sample per pixel Cycles always takes the middle of the pixel, whatever
    its filter; with more samples a box filter of 0.01 pixels keeps them there
  the seed is animated: Blender's default gives every frame the same noise, and there is nothing to average
  motion blur off: with it Cycles writes vectors that are all zero, without a word
  adaptive sampling and denoising off: both would hide what the samples are
What cannot be set right is said: an animated focal length and cuts between cameras are not in the Vector pass.
"""
import json
import os
import sys

import bpy


def stop(sentence):
    print('blender_setup: ' + sentence, file=sys.stderr, flush=True)
    os._exit(2)  # sys.exit() inside --python ends with 0 in background mode


def say(sentence):
    print('blender_setup: ' + sentence, flush=True)


def options():
    known = dict(out='//render', frames='', jitter='halton', samples='1', color='half', cryptomatte='no', save='',
                 render='yes')
    for item in sys.argv[sys.argv.index('--') + 1:] if '--' in sys.argv else []:
        name, equals, value = item.partition('=')
        if not equals or name not in known:
            stop('there is no option "%s"; there are %s' % (item, ', '.join(k + '=' for k in known)))
        known[name] = value
    return known


def frames_of(text, scene):
    if not text:
        return list(range(scene.frame_start, scene.frame_end + 1))
    frames = set()
    try:
        for piece in text.split(','):
            first, dash, last = piece.partition('-')
            frames.update(range(int(first), int(last if dash else first) + 1))
    except ValueError:
        stop('frames=%s: numbers and ranges with commas between are wanted, such as 1-16,20' % text)
    return sorted(frames)


def halton(index, base):
    value, part = 0.0, 1.0
    while index > 0:
        part /= base
        value += part * (index % base)
        index //= base
    return value


def read_jitter(text, frames):
    """Offset of each frame from the middle of the pixel, pixels, x right, y down."""
    if text == 'none':
        return {f: (0.0, 0.0) for f in frames}
    if text == 'halton':
        return {f: (halton((f - 1) % 16 + 1, 2) - 0.5, halton((f - 1) % 16 + 1, 3) - 0.5) for f in frames}
    try:
        with open(text) as file:
            lines = [line.strip() for line in file]
    except OSError as problem:
        stop('jitter=%s: cannot be read (%s)' % (text, problem.strerror))
    rows = [line.split(',') for line in lines if line and not line.startswith('#')]
    if not rows or rows[0] != ['frame', 'jx', 'jy']:
        stop('jitter=%s: the header frame,jx,jy is missing; write it with varve jitter, convention pixels' % text)
    try:
        table = {int(row[0]): (float(row[1]), float(row[2])) for row in rows[1:]}
    except (ValueError, IndexError):
        stop('jitter=%s: a line is not frame,jx,jy' % text)
    missing = [f for f in frames if f not in table]
    if missing:
        stop('jitter=%s: has no line for frame %d; give varve jitter a larger --count' % (text, missing[0]))
    return table


def set_up_scene(scene, o):
    r, c = scene.render, scene.cycles
    if r.engine != 'CYCLES':
        say('the engine was %s, which writes no vectors that can be used; now it is Cycles' % r.engine)
    r.engine = 'CYCLES'
    if r.use_motion_blur:
        say('motion blur is switched off: with it every vector is 0; add it after the resolve')
    r.use_motion_blur = False
    r.use_compositing = r.use_sequencer = False
    r.use_border = r.use_crop_to_border = False
    r.dither_intensity = 0
    if os.environ.get('RENDER_THREADS'):
        r.threads_mode, r.threads = 'FIXED', int(os.environ['RENDER_THREADS'])
    c.samples = int(o['samples'])
    c.use_adaptive_sampling = c.use_denoising = False
    c.use_animated_seed = True
    c.pixel_filter_type, c.filter_width = 'BOX', 0.01
    image = r.image_settings
    image.file_format, image.color_mode, image.exr_codec = 'OPEN_EXR_MULTILAYER', 'RGBA', 'ZIP'
    image.color_depth = {'half': '16', 'float': '32'}.get(o['color']) or stop('color= takes half or float')
    for item in ('date', 'time', 'render_time', 'frame', 'frame_range', 'memory', 'hostname', 'camera', 'lens',
                 'scene', 'marker', 'filename', 'sequencer_strip'):
        setattr(r, 'use_stamp_' + item, item in ('frame', 'camera'))
    r.use_stamp, r.use_stamp_note = False, True  # the headers only; the note holds camera and jitter


def set_up_layers(scene, cryptomatte):
    for layer in scene.view_layers:
        if not layer.use:
            continue
        layer.use_pass_combined = layer.use_pass_z = layer.use_pass_vector = True
        layer.use_pass_normal = layer.use_pass_object_index = True
        if cryptomatte:
            layer.use_pass_cryptomatte_object = True
            layer.pass_cryptomatte_depth = max(layer.pass_cryptomatte_depth, 6)
    used = {o.pass_index for o in scene.objects}
    free = (i for i in range(1, 32768) if i not in used)
    for o in sorted(scene.objects, key=lambda o: o.name):
        if o.type in ('MESH', 'CURVE', 'CURVES', 'SURFACE', 'FONT', 'META', 'VOLUME', 'POINTCLOUD') and not o.pass_index:
            o.pass_index = next(free, 0)


def pixel_in_shift(scene, camera):
    """One pixel to the right and one pixel down, in the units of the camera's shift."""
    r = scene.render
    width, height = image_size(scene)
    wide, high = width * r.pixel_aspect_x, height * r.pixel_aspect_y
    fit = camera.sensor_fit
    whole = high if fit == 'VERTICAL' or (fit == 'AUTO' and high > wide) else wide
    return r.pixel_aspect_x / whole, -r.pixel_aspect_y / whole


def image_size(scene):
    r = scene.render
    return r.resolution_x * r.resolution_percentage // 100, r.resolution_y * r.resolution_percentage // 100


def key_jitter(scene, frames, jitter):
    """Keys the shift of each frame's camera on top of what it was."""
    before = {}
    for f in frames:
        scene.frame_set(f)
        if scene.camera is None or scene.camera.type != 'CAMERA':
            stop('frame %d has no camera' % f)
        camera = scene.camera.data
        if camera.type == 'PANO':
            stop('camera "%s" is panoramic, which a shift cannot jitter' % scene.camera.name)
        before[f] = (camera, camera.shift_x, camera.shift_y)
    for camera in {entry[0] for entry in before.values()}:
        if camera.animation_data and camera.animation_data.action:
            curves = camera.animation_data.action.fcurves
            for curve in [c for c in curves if c.data_path in ('shift_x', 'shift_y')]:
                curves.remove(curve)
            if any(c.data_path in ('lens', 'ortho_scale', 'angle', 'sensor_width') for c in curves):
                say('camera "%s" has an animated focal length, which the Vector pass leaves out' % camera.name)
    for f, (camera, x, y) in before.items():
        px, py = pixel_in_shift(scene, camera)
        camera.shift_x, camera.shift_y = x + jitter[f][0] * px, y + jitter[f][1] * py
        camera.keyframe_insert('shift_x', frame=f)
        camera.keyframe_insert('shift_y', frame=f)
    for camera in {entry[0] for entry in before.values()}:
        for curve in camera.animation_data.action.fcurves:
            if curve.data_path in ('shift_x', 'shift_y'):
                for key in curve.keyframe_points:
                    key.interpolation = 'CONSTANT'


def note_of(scene, frame, jitter, samples):
    """Camera and jitter as JSON: `view` from world to camera, `proj` as OpenGL has it but without the jitter, both
    row by row."""
    graph = bpy.context.evaluated_depsgraph_get()
    camera = scene.camera.evaluated_get(graph)
    width, height = image_size(scene)
    proj = camera.calc_matrix_camera(graph, x=width, y=height, scale_x=scene.render.pixel_aspect_x,
                                     scale_y=scene.render.pixel_aspect_y)
    x, y = 2 * jitter[0] / width, 2 * jitter[1] / height
    if camera.data.type == 'ORTHO':
        proj[0][3] += x
        proj[1][3] -= y
    else:
        proj[0][2] -= x
        proj[1][2] += y
    flat = lambda matrix: [round(value, 7) for row in matrix for value in row]
    return json.dumps(dict(frame=frame, jitter=[round(v, 7) for v in jitter], spp=samples, camera=scene.camera.name,
                           view=flat(camera.matrix_world.inverted()), proj=flat(proj)), separators=(',', ':'))


def main():
    o = options()
    scene = bpy.context.scene
    frames = frames_of(o['frames'], scene)
    jitter = read_jitter(o['jitter'], frames)
    set_up_scene(scene, o)
    set_up_layers(scene, o['cryptomatte'] == 'yes')
    key_jitter(scene, frames, jitter)
    folder = bpy.path.abspath(o['out'])
    os.makedirs(folder, exist_ok=True)
    scene.render.filepath = os.path.join(folder, 'frame.####')
    if o['save']:
        bpy.ops.wm.save_as_mainfile(filepath=os.path.abspath(o['save']))
    with open(os.path.join(folder, 'jitter.csv'), 'w') as file:
        file.write('# sample position minus pixel center, pixels, x right, y down\nframe,jx,jy\n')
        for f in frames:
            file.write('%d,%.7f,%.7f\n' % (f, *jitter[f]))
    cuts, camera = [], None
    for f in frames:
        scene.frame_set(f)
        if camera is not None and scene.camera != camera:
            cuts.append(f)
        camera = scene.camera
        if o['render'] != 'yes':
            continue
        scene.render.stamp_note_text = note_of(scene, f, jitter[f], int(o['samples']))
        scene.render.filepath = os.path.join(folder, 'frame.%04d.exr' % f)
        bpy.ops.render.render(write_still=True)
    if cuts:
        say('the camera changes, which the Vector pass does not tell; resolve with --cuts %s' % ','.join(map(str, cuts)))
    say('done: varve probe %s --check-jitter 16' % os.path.join(folder, 'frame.####.exr'))


if __name__ == '__main__':  # scripts/rerender_blender.py uses what is here
    try:
        main()
    except Exception as problem:  # background mode would go on and end with 0
        stop('%s: %s' % (type(problem).__name__, problem))
