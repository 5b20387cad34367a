"""Shared helpers for the Blender scene scripts (Blender 3.4, Cycles CPU)."""
import bpy, json, math, os, sys, time

W, H = 320, 180


def args():
    a = sys.argv[sys.argv.index('--') + 1:] if '--' in sys.argv else []
    out = {}
    for item in a:
        k, _, v = item.partition('=')
        out[k] = v
    return out


def halton(i, base):
    f, r = 1.0, 0.0
    while i > 0:
        f /= base
        r += f * (i % base)
        i //= base
    return r


def jitter(frame, cycle=16):
    """Sample offset from the pixel center, in pixels, +x right, +y down."""
    i = (frame - 1) % cycle + 1
    return halton(i, 2) - 0.5, halton(i, 3) - 0.5


def sample_jitter(k, n):
    """Jitter of sample k of n per frame: the next n points of one long Halton(2,3) walk, 64 points."""
    return lambda frame: jitter((frame - 1) * n + k + 1, 64)


def shift_for(jx, jy):
    """Blender camera shift which moves every sample by (jx, jy) pixels.
    Shift is measured in units of the larger image side (sensor fit AUTO, square
    pixels), y up.  W and H are read when called: a scene may set them before main()."""
    m = float(max(W, H))
    return jx / m, -jy / m


def reset():
    bpy.ops.wm.read_factory_settings(use_empty=True)
    s = bpy.context.scene
    s.render.engine = 'CYCLES'
    s.render.resolution_x, s.render.resolution_y = W, H
    s.render.resolution_percentage = 100
    s.render.fps = 24
    s.render.use_motion_blur = False
    s.render.use_compositing = False
    s.render.use_sequencer = False
    s.render.threads_mode = 'FIXED'
    s.render.threads = int(os.environ.get('RENDER_THREADS', '2'))
    s.view_settings.view_transform = 'Standard'
    s.render.dither_intensity = 0
    c = s.cycles
    c.device = 'CPU'
    c.use_adaptive_sampling = False
    c.use_denoising = False
    c.max_bounces = 4
    c.diffuse_bounces = 2
    c.glossy_bounces = 2
    c.transmission_bounces = 4
    c.transparent_max_bounces = 16
    c.caustics_reflective = False
    c.caustics_refractive = False
    c.sample_clamp_direct = 0
    c.sample_clamp_indirect = 8
    c.pixel_filter_type = 'BOX'
    return s


def passes(vl, extra=()):
    vl.use_pass_combined = True
    vl.use_pass_z = True
    vl.use_pass_vector = True
    vl.use_pass_normal = True
    vl.use_pass_object_index = True
    for e in extra:
        setattr(vl, 'use_pass_' + e, True)


# ---------------------------------------------------------------- materials
def material(name, color=(0.8, 0.8, 0.8), rough=0.6, metal=0.0, emit=None, strength=1.0):
    m = bpy.data.materials.new(name)
    m.use_nodes = True
    nt = m.node_tree
    if emit is not None:
        nt.nodes.clear()
        e = nt.nodes.new('ShaderNodeEmission')
        e.inputs['Color'].default_value = (*emit, 1)
        e.inputs['Strength'].default_value = strength
        o = nt.nodes.new('ShaderNodeOutputMaterial')
        nt.links.new(e.outputs[0], o.inputs['Surface'])
        return m
    b = nt.nodes['Principled BSDF']
    b.inputs['Base Color'].default_value = (*color, 1)
    b.inputs['Roughness'].default_value = rough
    b.inputs['Metallic'].default_value = metal
    return m


def textured(name, node_type, scale, c1, c2, rough=0.7, coord='Object', **props):
    """Principled material whose base color comes from a two-color procedural texture."""
    m = material(name, rough=rough)
    nt = m.node_tree
    b = nt.nodes['Principled BSDF']
    tc = nt.nodes.new('ShaderNodeTexCoord')
    t = nt.nodes.new(node_type)
    t.inputs['Scale'].default_value = scale
    for k, v in props.items():
        if k in t.inputs:
            t.inputs[k].default_value = v
        else:
            setattr(t, k, v)
    nt.links.new(tc.outputs[coord], t.inputs['Vector'])
    if 'Color1' in t.inputs:
        t.inputs['Color1'].default_value = (*c1, 1)
        t.inputs['Color2'].default_value = (*c2, 1)
        nt.links.new(t.outputs['Color'], b.inputs['Base Color'])
    else:
        ramp = nt.nodes.new('ShaderNodeValToRGB')
        ramp.color_ramp.elements[0].position = 0.4
        ramp.color_ramp.elements[1].position = 0.6
        ramp.color_ramp.elements[0].color = (*c1, 1)
        ramp.color_ramp.elements[1].color = (*c2, 1)
        out = 'Fac' if 'Fac' in t.outputs else t.outputs[0].name
        nt.links.new(t.outputs[out], ramp.inputs['Fac'])
        nt.links.new(ramp.outputs['Color'], b.inputs['Base Color'])
    return m


def matte(name, color=(0.8, 0.8, 0.8), ambient=0.25, node_type=None, scale=1.0, color2=None, **props):
    """Diffuse BSDF plus a constant ambient emission: noise-free at one sample per pixel when the
    only light is a sharp sun.  Optional two-color procedural texture (object coordinates)."""
    m = bpy.data.materials.new(name)
    m.use_nodes = True
    m.cycles.sample_as_light = False
    nt = m.node_tree
    nt.nodes.clear()
    d, e, a = (nt.nodes.new('ShaderNode' + k) for k in ('BsdfDiffuse', 'Emission', 'AddShader'))
    o = nt.nodes.new('ShaderNodeOutputMaterial')
    nt.links.new(d.outputs[0], a.inputs[0])
    nt.links.new(e.outputs[0], a.inputs[1])
    nt.links.new(a.outputs[0], o.inputs['Surface'])
    e.inputs['Strength'].default_value = ambient
    if node_type is None:
        d.inputs['Color'].default_value = e.inputs['Color'].default_value = (*color, 1)
        return m
    tc, t = nt.nodes.new('ShaderNodeTexCoord'), nt.nodes.new(node_type)
    t.inputs['Scale'].default_value = scale
    for k, v in props.items():
        if k in t.inputs:
            t.inputs[k].default_value = v
        else:
            setattr(t, k, v)
    nt.links.new(tc.outputs['Object'], t.inputs['Vector'])
    if 'Color1' in t.inputs:
        t.inputs['Color1'].default_value, t.inputs['Color2'].default_value = (*color, 1), (*color2, 1)
        src = t.outputs['Color']
    else:
        ramp = nt.nodes.new('ShaderNodeValToRGB')
        ramp.color_ramp.elements[0].position, ramp.color_ramp.elements[1].position = 0.4, 0.6
        ramp.color_ramp.elements[0].color, ramp.color_ramp.elements[1].color = (*color, 1), (*color2, 1)
        nt.links.new(t.outputs['Fac' if 'Fac' in t.outputs else 0], ramp.inputs['Fac'])
        src = ramp.outputs['Color']
    nt.links.new(src, d.inputs['Color'])
    nt.links.new(src, e.inputs['Color'])
    return m


def mirror(name, color=(1, 1, 1), highlight=0.35, rough=0.25):
    """Sharp mirror plus a rough glossy lobe (for the sun highlight)."""
    m = bpy.data.materials.new(name)
    m.use_nodes = True
    nt = m.node_tree
    nt.nodes.clear()
    g0, g1, mix = (nt.nodes.new('ShaderNode' + k) for k in ('BsdfGlossy', 'BsdfGlossy', 'MixShader'))
    o = nt.nodes.new('ShaderNodeOutputMaterial')
    for g, r in ((g0, 0.0), (g1, rough)):
        g.inputs['Color'].default_value = (*color, 1)
        g.inputs['Roughness'].default_value = r
    mix.inputs['Fac'].default_value = highlight
    nt.links.new(g0.outputs[0], mix.inputs[1])
    nt.links.new(g1.outputs[0], mix.inputs[2])
    nt.links.new(mix.outputs[0], o.inputs['Surface'])
    return m


def glow(name, color, strength):
    """Emission that is seen but not sampled as a light."""
    m = material(name, emit=color, strength=strength)
    m.cycles.sample_as_light = False
    return m


# ------------------------------------------------------------------ objects
def _finish(name, mat, index):
    o = bpy.context.active_object
    o.name = name
    o.pass_index = index
    if mat is not None:
        o.data.materials.append(mat)
    return o


def plane(name, size, loc, rot=(0, 0, 0), mat=None, index=1, scale=(1, 1, 1)):
    bpy.ops.mesh.primitive_plane_add(size=size, location=loc, rotation=rot)
    o = _finish(name, mat, index)
    o.scale = scale
    return o


def cube(name, dims, loc, rot=(0, 0, 0), mat=None, index=1):
    bpy.ops.mesh.primitive_cube_add(size=1, location=loc, rotation=rot)
    o = _finish(name, mat, index)
    o.scale = dims
    return o


def sphere(name, r, loc, mat=None, index=1, smooth=True):
    bpy.ops.mesh.primitive_uv_sphere_add(segments=48, ring_count=24, radius=r, location=loc)
    o = _finish(name, mat, index)
    if smooth:
        for p in o.data.polygons:
            p.use_smooth = True
    return o


def rod(name, a, b, r, mat=None, index=1, verts=10):
    from mathutils import Vector
    a, b = Vector(a), Vector(b)
    d = b - a
    bpy.ops.mesh.primitive_cylinder_add(vertices=verts, radius=r, depth=d.length,
                                        location=(a + b) / 2)
    o = _finish(name, mat, index)
    o.rotation_mode = 'QUATERNION'
    o.rotation_quaternion = Vector((0, 0, 1)).rotation_difference(d.normalized())
    for p in o.data.polygons:
        p.use_smooth = len(p.vertices) == 4
    return o


def camera(name, loc, target, lens=35.0):
    from mathutils import Vector
    cd = bpy.data.cameras.new(name)
    cd.sensor_fit = 'AUTO'
    cd.sensor_width = 36.0
    cd.lens = lens
    cd.clip_start, cd.clip_end = 0.05, 500
    o = bpy.data.objects.new(name, cd)
    bpy.context.scene.collection.objects.link(o)
    look(o, loc, target)
    return o


def look(o, loc, target):
    from mathutils import Vector
    o.location = loc
    o.rotation_mode = 'QUATERNION'
    q = (Vector(target) - Vector(loc)).to_track_quat('-Z', 'Y')
    o.rotation_quaternion = q


def light(name, kind, loc, rot, energy, size=1.0, color=(1, 1, 1)):
    ld = bpy.data.lights.new(name, kind)
    ld.energy = energy
    ld.color = color
    if kind == 'SUN':
        ld.angle = size
    elif kind == 'AREA':
        ld.size = size
    else:
        ld.shadow_soft_size = size
    o = bpy.data.objects.new(name, ld)
    o.location, o.rotation_euler = loc, rot
    bpy.context.scene.collection.objects.link(o)
    return o


def world(color, strength=1.0, sample=True, diffuse=True):
    """sample=False: no next-event estimation towards the sky; diffuse=False: no sky light on
    diffuse surfaces at all (both reduce the noise of one-sample frames)."""
    w = bpy.data.worlds.new('World')
    bpy.context.scene.world = w
    w.use_nodes = True
    bg = w.node_tree.nodes['Background']
    bg.inputs['Color'].default_value = (*color, 1)
    bg.inputs['Strength'].default_value = strength
    if not sample:
        w.cycles.sampling_method = 'NONE'
    w.cycles_visibility.diffuse = diffuse


def keys(o, path, pairs, interp='LINEAR', index=-1):
    """pairs: (frame, value)."""
    for f, v in pairs:
        setattr(o, path, v)
        o.keyframe_insert(path, frame=f)
    for fc in o.animation_data.action.fcurves:
        if fc.data_path == path:
            for k in fc.keyframe_points:
                k.interpolation = interp


def camera_path(cam, fn, frames):
    """Key location and rotation on every frame from fn(frame) -> (loc, target)."""
    last = None
    for f in frames:
        loc, target = fn(f)
        look(cam, loc, target)
        if last is not None and last.dot(cam.rotation_quaternion) < 0:
            cam.rotation_quaternion.negate()
        last = cam.rotation_quaternion.copy()
        cam.keyframe_insert('location', frame=f)
        cam.keyframe_insert('rotation_quaternion', frame=f)
    for fc in cam.animation_data.action.fcurves:
        for k in fc.keyframe_points:
            k.interpolation = 'LINEAR'


# ---------------------------------------------------------------- rendering
def _note(cam, f, jx, jy, mode, spp):
    """Short JSON with what a resolver needs; Blender puts it into the EXR header
    as the string attribute 'Note'."""
    g = bpy.context.evaluated_depsgraph_get()
    ce = cam.evaluated_get(g)
    view = ce.matrix_world.inverted()
    proj = ce.calc_matrix_camera(g, x=W, y=H)
    proj[0][2] = proj[1][2] = 0.0     # leave the jitter (camera shift) out of the projection
    flat = lambda m: [round(x, 7) for r in m for x in r]
    return json.dumps(dict(frame=f, jitter=[round(jx, 6), round(jy, 6)], mode=mode, spp=spp,
                           camera=cam.name, view=flat(view), proj=flat(proj)),
                      separators=(',', ':'))


def render(scene, outdir, frames, mode, spp, seed=1, color_only=False, jitter_of=jitter):
    """mode 'jit': point samples (box filter of 0.01 px) with the shift jitter_of(frame).
    mode 'ref': box filter of 1 px, no shift."""
    os.makedirs(outdir, exist_ok=True)
    c, r = scene.cycles, scene.render
    c.samples = spp
    c.seed = seed
    c.use_animated_seed = True
    c.filter_width = 0.01 if mode == 'jit' else 1.0
    for item in ('date', 'time', 'render_time', 'frame', 'frame_range', 'memory', 'hostname',
                 'camera', 'lens', 'scene', 'marker', 'filename', 'sequencer_strip'):
        setattr(r, 'use_stamp_' + item, item in ('frame', 'camera'))
    r.use_stamp = False
    r.use_stamp_note = True
    im = r.image_settings
    im.file_format = 'OPEN_EXR' if color_only else 'OPEN_EXR_MULTILAYER'
    im.color_mode = 'RGBA'
    im.color_depth = '16'
    im.exr_codec = 'ZIP'
    rows = []
    for f in frames:
        scene.frame_set(f)
        cam = scene.camera
        jx, jy = jitter_of(f) if mode == 'jit' else (0.0, 0.0)
        cam.data.shift_x, cam.data.shift_y = shift_for(jx, jy)
        r.stamp_note_text = _note(cam, f, jx, jy, mode, spp)
        r.filepath = os.path.join(outdir, 'frame.%04d.exr' % f)
        t = time.time()
        bpy.ops.render.render(write_still=True)
        rows.append((f, jx, jy, cam.name, time.time() - t))
        print('RENDERED %s frame %d %.2fs' % (mode, f, rows[-1][-1]), flush=True)
    with open(os.path.join(outdir, 'jitter.csv'), 'w') as fp:
        fp.write('# sample position minus pixel center, in pixels, +x right, +y down\n')
        fp.write('frame,jx,jy\n')
        for f, jx, jy, _, _ in rows:
            fp.write('%d,%.7f,%.7f\n' % (f, jx, jy))
    with open(os.path.join(outdir, 'timing.csv'), 'w') as fp:
        fp.write('frame,seconds\n')
        for row in rows:
            fp.write('%d,%.3f\n' % (row[0], row[-1]))


def strip_passes(scene):
    for vl in scene.view_layers:
        for p in dir(vl):
            if p.startswith('use_pass_') and p != 'use_pass_combined':
                try:
                    setattr(vl, p, False)
                except Exception:
                    pass


def frames_of(text, default):
    text = text or default
    out = []
    for part in text.split(','):
        a, _, b = part.partition('-')
        out += list(range(int(a), int(b or a) + 1))
    return out


def main(build, default_frames='1-24', default_ref='17-24', ref_spp=512):
    """Options after '--': out=DIR what=jit|samples|ref|refb|ss4|ss16|blend frames=1-24 spp=N n=4 layer=NAME
    samples: n one-sample renders of every frame, each with its own jitter and seed, in sample.0 .. """
    a = args()
    out = os.path.abspath(a.get('out', '.'))
    what = a.get('what', 'jit')
    scene = reset()
    build(scene)
    if what == 'jit':
        render(scene, os.path.join(out, 'jit'), frames_of(a.get('frames'), default_frames),
               'jit', int(a.get('spp', 1)), seed=1)
    elif what == 'samples':
        n = int(a.get('n', 4))
        for k in range(n):
            render(scene, os.path.join(out, 'sample.%d' % k), frames_of(a.get('frames'), default_frames),
                   'jit', 1, seed=11 + k, jitter_of=sample_jitter(k, n))
    elif what in ('ref', 'refb', 'ss4', 'ss16'):
        spp = int(a.get('spp', {'ref': ref_spp, 'refb': ref_spp, 'ss4': 4, 'ss16': 16}[what]))
        keep = a.get('layer') or None
        if len(scene.view_layers) > 1:
            for vl in scene.view_layers:
                vl.use = vl.name == (keep or scene.view_layers[0].name)
        strip_passes(scene)
        render(scene, os.path.join(out, what + ('_' + keep if keep else '')),
               frames_of(a.get('frames'), default_ref),
               'ref', spp, seed={'ref': 101, 'refb': 202, 'ss4': 303, 'ss16': 404}[what],
               color_only=True)
    elif what == 'blend':
        bpy.ops.wm.save_as_mainfile(filepath=os.path.join(out, 'scene.blend'))
