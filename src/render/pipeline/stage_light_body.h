/* stage_light_body.h - microfacet lights: highlights, and early-outs for runs of samples. Part of
   pipeline_body.h. */

/* ---- microfacet lights ---- */

/* Kernel parameters of a model other than Blinn-Phong. */
static WR_T(WrKernMatter) matter_of(const WrMatter *m)
{
    WR_T(WrKernMatter) out = { .kd = (REAL)m->kd, .ks = (REAL)m->ks };
    for (int c = 0; c < 3; c++) out.colour[c] = (REAL)m->colour[c];
    out.shininess = (REAL)m->shininess, out.scale = (REAL)m->scale, out.alpha = (REAL)m->alpha;
    out.ior = (REAL)m->ior, out.f0 = (REAL)m->f0, out.metal = (REAL)m->metal;
    out.a = (REAL)m->a, out.b = (REAL)m->b;
    out.mean = (REAL)m->mean, out.again = (REAL)m->again;
    for (int i = 0; i < WR_ALBEDO_TERMS; i++) out.albedo[i] = (REAL)m->albedo[i];
    return out;
}

/* The kernel of such a model; NULL: the model is computed in stages. */
static WR_T(WrReflectKernel) reflect_of(const WrTileJob *job)
{
    const WrEnergy energy = job->plan->kept ? WR_ENERGY_KEPT : WR_ENERGY_PUBLISHED;
    return KERNELS_OF(job)->reflect[job->plan->model][energy];
}

/* Brightness below which `dials faint=` omits a highlight, relative to the lamp's light; 0: never. */
static REAL least_of(const WrTileJob *job, const WR_T(WrKernLight) * light)
{
    const double most =
        fmax((double)light->rgb[0], fmax((double)light->rgb[1], (double)light->rgb[2]));
    return most > 0 ? (REAL)(job->plan->faint / most) : (REAL)0;
}

/* True if no highlight in the run is wider than the material's own (E39; after bend_strip). */
static bool is_narrow(const WrTileJob *job, const Strip *strip)
{
    if (!runs(job, WR_EFFECT_SPREAD)) return true;
    return !runs(job, WR_EFFECT_WIDENED) && strip->gathered;
}

static double chord_of(double cosine)
{
    return sqrt(fmax(0, 2 - 2 * cosine)) + 1e-3; /* margin for the rounding of the cosine */
}

/* Upper bound of a highlight over a run (E37). S0 = l0 + v0 is S = l + v of one sample; no other S is farther
   from it than e, so h is within y = asin(e / |S0|) of the axis, and n' no nearer to h than x - y, x its angle
   to the axis:
     D is at most that of this angle,   V (n.l) at most 1 / (2 sqrt(a^2 + (1 - a^2) (n.v)^2)),
     G / (n.v) at most 1 / (n.v),
     F at most f0 + (1 - f0) (1 - v.h)^5 of v.h = (|S0| - e) / 2. */
static double most_of(const WR_T(WrKernMatter) * m, WrReflectHighlight highlight, double length,
                      const REAL found[4])
{
    const double e = chord_of((double)found[2]) + chord_of((double)found[3]);
    const double nv = (double)found[0], a2 = (double)m->alpha * (double)m->alpha;
    if (!(e < 0.5 * length)) return INFINITY;
    const double cx = fmin((double)found[1] + 1e-6, 1), sx = sqrt(1 - cx * cx);
    const double sy = e / length, cy = sqrt(1 - sy * sy); /* sine and cosine of the angle */
    if (!(cx < cy)) return INFINITY;
    const double off = 1 - fmax(0, fmin(0.5 * (length - e), 1)), p = off * off * off * off * off;
    const double c = fmax(0, cx * cy + sx * sy), w = a2 * c * c + 1 - c * c;
    const double f0 = (double)m->f0, metal = (double)m->metal, f = f0 + (1 - f0) * p;
    const double d = (double)m->ks * a2 / (w * w);
    switch (highlight) {
    case WR_HIGHLIGHT_CAVITIES: return d * (double)m->scale / nv;
    case WR_HIGHLIGHT_SMITH:
        return d * 0.5 / sqrt(a2 + (1 - a2) * nv * nv) * (f * (1 - metal) + metal);
    case WR_HIGHLIGHT_NONE:
    case WR_HIGHLIGHT_HALF:
    case WR_HIGHLIGHT_POWER: break;
    }
    return INFINITY;
}

/* True if every highlight is certainly below `least`. *faces: every n' faces the viewer.
   found[0] is the least n'.v, found[1] the largest n'.axis, found[2] and found[3] the least cosines of v and l
   to those of the middle sample. */
static bool is_faint(const WrTileJob *job, const WR_T(WrKernMatter) * m, const Strip *strip,
                     bool *faces)
{
    const int mid = strip->count / 2;
    const REAL v0[3] = { strip->vx[mid], strip->vy[mid], strip->vz[mid] };
    const REAL l0[3] = { strip->lx[mid], strip->ly[mid], strip->lz[mid] };
    REAL axis[3], found[4], sum = 0;
    for (int k = 0; k < 3; k++) axis[k] = v0[k] + l0[k], sum += axis[k] * axis[k];
    const double length = sqrt((double)sum);
    for (int k = 0; k < 3; k++) axis[k] = length > 0 ? axis[k] / (REAL)length : 0;
    KERNELS_OF(job)->survey(axis, v0, l0, strip, found);
    *faces = (double)found[0] >= WR_FACED_FROM;
    return *faces && most_of(m, wr_reflects[job->plan->model].highlight, length, found) <
                         0.999 * (double)m->least;
}

/* Microfacet form for this run (E37, E39, E40). */
static WrReflectSpread form_of(const WrTileJob *job, const WR_T(WrKernMatter) * matter,
                               const Strip *strip)
{
    bool faces = false;
    if (!is_narrow(job, strip)) return job->plan->lean ? WR_REFLECT_LEAN : WR_REFLECT_ROUND;
    if (runs(job, WR_EFFECT_VARIED) || runs(job, WR_EFFECT_FACED) ||
        !wr_reflects[job->plan->model].facets)
        return WR_REFLECT_AS_IT_IS;
    if (matter->least > 0 && is_faint(job, matter, strip, &faces)) return WR_REFLECT_DULL;
    if (matter->least > 0 ? faces : KERNELS_OF(job)->faces(strip)) return WR_REFLECT_FACING;
    return WR_REFLECT_AS_IT_IS;
}

/* Adds one light by a model other than Blinn-Phong. Returns true if its highlight was skipped. */
static bool reflect_strip(const WrTileJob *job, const WR_T(WrKernLight) * light, Strip *strip,
                          Watch *watch)
{
    WR_T(WrKernMatter) matter = matter_of(&job->matter);
    const bool shines = runs(job, WR_EFFECT_SPECULAR);
    matter.least = least_of(job, light);
    const WrReflectSpread how = form_of(job, &matter, strip);
    if (runs(job, WR_EFFECT_VARIED))
        KERNELS_OF(job)->reflect_vary(light, &matter, VARY_OF(job), job->plan->model,
                                      job->plan->kept, how, strip);
    else reflect_of(job)(light, &matter, how, strip);
    if (runs(job, WR_EFFECT_DIFFUSE)) did(watch, WR_EFFECT_DIFFUSE);
    if (shines) did(watch, WR_EFFECT_SPECULAR);
    if (runs(job, WR_EFFECT_KEPT)) did(watch, WR_EFFECT_KEPT);
    if (runs(job, WR_EFFECT_FACED)) did(watch, WR_EFFECT_FACED);
    if (runs(job, WR_EFFECT_FAINT)) did(watch, WR_EFFECT_FAINT);
    did(watch, WR_EFFECT_MODEL);
    watch_lap(watch, shines ? WR_STAGE_SPECULAR : WR_STAGE_DIFFUSE);
    keep_half3(job, strip->dr, strip->dg, strip->db, strip->count, watch);
    keep_half3(job, strip->sr, strip->sg, strip->sb, strip->count, watch);
    return how == WR_REFLECT_DULL;
}

/* ---- lighting ---- */

/* Lighting of a strip: a single light in one pass, several stage by stage. Part of
   pipeline_body.h. */

static void shine_strip(const WrTileJob *job, const WR_T(WrKernLight) * light, Strip *strip)
{
    const Kernels *k = KERNELS_OF(job);
    const WrMaterial *m = &job->scene->material;
    const WR_T(WrKernShine) shine = { (REAL)m->specular, (REAL)m->shininess, m->gate };
    if (is_narrow(job, strip)) k->specular(light, shine.ks, shine.shininess, shine.gate, strip);
    else if (job->plan->lean) k->specular_lean(light, &shine, strip);
    else k->specular_toksvig(light, &shine, strip);
}

static void bound_strip(const WrTileJob *job, const Rays *rays, const WR_T(WrKernLight) * light,
                        Strip *strip)
{
    const WrMaterial *m = &job->scene->material;
    const WR_T(WrKernShine) shine = { runs(job, WR_EFFECT_SPECULAR) ? (REAL)m->specular : (REAL)0,
                                      (REAL)m->shininess, m->gate };
    double most = fmax(m->colour.x, fmax(m->colour.y, m->colour.z));
    KERNELS_OF(job)->bound_light(rays, light, &shine, (REAL)(m->diffuse * most), strip);
}

/* P and n' in world proportions where the object is stretched: n' along the object's axes, normalised again
   (HC153).
   Divided by the largest component first: squares of tiny cofactors would underflow in float. */
static void stretch_strip(const WrView *view, Strip *strip)
{
    const REAL s[3] = { (REAL)view->stretch[0], (REAL)view->stretch[1], (REAL)view->stretch[2] };
    const REAL c[3] = { (REAL)view->cofactor[0], (REAL)view->cofactor[1], (REAL)view->cofactor[2] };
    for (int i = 0; i < strip->count && view->stretched; i++) {
        const REAL x = c[0] * strip->bx[i], y = c[1] * strip->by[i], z = c[2] * strip->bz[i];
        const REAL most = (REAL)fmax(fabs((double)x), fmax(fabs((double)y), fabs((double)z)));
        const REAL a = most > 0 ? x / most : 0, b = most > 0 ? y / most : 0,
                   d = most > 0 ? z / most : 0;
        const REAL sum = a * a + b * b + d * d, inv = sum > 0 ? 1 / (REAL)sqrt((double)sum) : 0;
        strip->bx[i] = a * inv, strip->by[i] = b * inv, strip->bz[i] = d * inv;
        strip->px[i] *= s[0], strip->py[i] *= s[1], strip->pz[i] *= s[2];
    }
}

/* Adds one light. Returns true if its highlight was skipped. */
static bool lamp_strip(const WrTileJob *job, const Rays *rays, const WR_T(WrKernLight) * light,
                       const WrSink *sink, Strip *strip, Watch *watch)
{
    const Kernels *k = KERNELS_OF(job);
    k->light(light, strip);
    watch_lap(watch, WR_STAGE_DIFFUSE);
    if (runs(job, WR_EFFECT_HALF)) keep_half(strip->n_dot_l, strip->count);
    keep_half3(job, strip->lx, strip->ly, strip->lz, strip->count, watch);
    if (reflect_of(job)) return reflect_strip(job, light, strip, watch);
    if (runs(job, WR_EFFECT_DIFFUSE)) {
        k->diffuse(light, (REAL)job->scene->material.diffuse, strip);
        did(watch, WR_EFFECT_DIFFUSE);
    }
    watch_lap(watch, WR_STAGE_DIFFUSE);
    keep_half3(job, strip->dr, strip->dg, strip->db, strip->count, watch);
    if (runs(job, WR_EFFECT_SPECULAR)) {
        shine_strip(job, light, strip);
        did(watch, WR_EFFECT_SPECULAR);
        watch_lap(watch, WR_STAGE_SPECULAR);
        keep_half3(job, strip->sr, strip->sg, strip->sb, strip->count, watch);
    }
    if (sink->bound) bound_strip(job, rays, light, strip);
    watch_lap(watch, WR_STAGE_BOUND);
    return false;
}

/* Adds one light with shadows of the relief and of objects. */
static bool shadowed_lamp(const WrTileJob *job, const Rays *rays, const WR_T(WrKernLight) * light,
                          const WrSink *sink, Strip *strip, Watch *watch)
{
    Sums before;
    const bool shadows = runs(job, WR_EFFECT_SHADOW), casts = runs(job, WR_EFFECT_CAST);
    if (shadows || casts) keep_sums(strip, &before);
    const bool dull = lamp_strip(job, rays, light, sink, strip, watch);
    /* For a displaced surface, shadow rays hit its own relief and replace the horizons. */
    const bool decided = casts && job->dice && light->shadow;
    if (shadows && !decided) shadow_strip(job, light, &before, strip, watch);
    if (casts) cast_strip(job, light, &before, strip, watch);
    return dull;
}

/* Adds the diffuse light of the environment. */
static void surround_strip(const WrTileJob *job, Strip *strip, Watch *watch)
{
    const WrEnvironmentMapLook *look = &job->surround;
    const bool turns = runs(job, WR_EFFECT_HARMONICS);
    if (runs(job, WR_EFFECT_VARIED))
        KERNELS_OF(job)->surround_vary(SURROUND_OF(look), VARY_OF(job), strip);
    else KERNELS_OF(job)->surround[turns][look->shares](SURROUND_OF(look), strip);
    if (turns) did(watch, WR_EFFECT_HARMONICS);
    did(watch, WR_EFFECT_SURROUND);
    watch_lap(watch, WR_STAGE_SURROUND);
    keep_half3(job, strip->dr, strip->dg, strip->db, strip->count, watch);
}

/* Adds the reflection of the environment. */
static void mirror_strip(const WrTileJob *job, Strip *strip, Watch *watch)
{
    const Kernels *k = KERNELS_OF(job);
    const WrEnvironmentMapLook *look = &job->surround;
    if (job->plan->graded)
        k->mirror_vary(MIRROR_OF(look), VARY_OF(job), runs(job, WR_EFFECT_SPREAD), strip);
    else (look->mirror.rgba ? k->mirror : k->mirror_even)(MIRROR_OF(look), strip);
    if (runs(job, WR_EFFECT_BLUR)) did(watch, WR_EFFECT_BLUR);
    did(watch, WR_EFFECT_MIRROR);
    watch_lap(watch, WR_STAGE_MIRROR);
    keep_half3(job, strip->dr, strip->dg, strip->db, strip->count, watch);
    keep_half3(job, strip->sr, strip->sg, strip->sb, strip->count, watch);
}

/* The fused kernel for one light, if nothing else needs its intermediate results; else NULL. */
static WR_T(WrShadeKernel) single_pass(const WrTileJob *job, const Rays *rays, const WrSink *sink)
{
    const bool shines = runs(job, WR_EFFECT_SPECULAR);
    if (runs(job, WR_EFFECT_MODEL)) return NULL;
    if (runs(job, WR_EFFECT_SURROUND) || runs(job, WR_EFFECT_MIRROR)) return NULL;
    if (runs(job, WR_EFFECT_CAST)) return NULL;
    if (job->view->light_count != 1 || sink->bound || runs(job, WR_EFFECT_HALF)) return NULL;
    if (!shines && !runs(job, WR_EFFECT_DIFFUSE)) return NULL;
    if (shines && runs(job, WR_EFFECT_SPREAD)) return NULL;
    return KERNELS_OF(job)
        ->shade[VIEWED(job->view, lights)->point][rays->perspective][shines][pictured(job)];
}

/* Material parameters for one lamp. */
typedef struct LampMatter {
    WR_T(WrKernShine) shine;
    WR_T(WrKernMaterial) material;
} LampMatter;

static LampMatter lamp_matter(const WrTileJob *job, bool ambient)
{
    const WrMaterial *m = &job->scene->material;
    const bool diffuse = runs(job, WR_EFFECT_DIFFUSE);
    return (LampMatter){ { (REAL)m->specular, (REAL)m->shininess, m->gate },
                         { ambient ? (REAL)m->ambient : (REAL)0,
                           diffuse ? (REAL)m->diffuse : (REAL)0,
                           { (REAL)m->colour.x, (REAL)m->colour.y, (REAL)m->colour.z } } };
}

static void note_light(const WrTileJob *job, Watch *watch)
{
    if (runs(job, WR_EFFECT_DIFFUSE)) did(watch, WR_EFFECT_DIFFUSE);
    if (runs(job, WR_EFFECT_SPECULAR)) did(watch, WR_EFFECT_SPECULAR);
    watch_lap(watch, WR_STAGE_LIGHT);
}

#ifdef HAS_WIDE
/* Shades with hand-written SIMD. False: the stages do the work. */
static bool shaded_wide(const WrTileJob *job, const Rays *rays, const LampMatter *m, Strip *strip)
{
    return job->wide &&
           job->wide->shade(rays, job->view->lights, &m->shine, &m->material, pictured(job), strip);
}
#else
static bool shaded_wide(const WrTileJob *job, const Rays *rays, const LampMatter *m, Strip *strip)
{
    (void)job, (void)rays, (void)m, (void)strip;
    return false;
}
#endif

static void light_at_once(const WrTileJob *job, const Rays *rays, WR_T(WrShadeKernel) shade,
                          bool ambient, Strip *strip, Watch *watch)
{
    const LampMatter m = lamp_matter(job, ambient);
    const bool shines = runs(job, WR_EFFECT_SPECULAR);
    if (!shines || !shaded_wide(job, rays, &m, strip))
        shade(rays, VIEWED(job->view, lights), &m.shine, &m.material, strip);
    note_light(job, watch);
}

/* C limited to 0..1 for an energy-conserving model: more would reflect more light than arrives (HC110). */
static WrVec3 colour_within(const WrTileJob *job, Strip *strip)
{
    const WrMaterial *m = &job->scene->material;
    const WrVec3 c = m->colour, white = { 1, 1, 1 };
    const bool kept = wr_reflect_shares(&wr_reflects[m->model], m->energy == WR_ENERGY_KEPT);
    if (!kept || (!pictured(job) && c.x <= 1 && c.y <= 1 && c.z <= 1)) return c;
    REAL *const of[3] = { strip->cr, strip->cg, strip->cb };
    const REAL by[3] = { (REAL)c.x, (REAL)c.y, (REAL)c.z };
    for (int k = 0; k < 3; k++)
        for (int i = 0; i < strip->count; i++) {
            const REAL own = by[k] * of[k][i], least = own > 0 ? own : (REAL)0;
            of[k][i] = least < 1 ? least : (REAL)1;
        }
    return white;
}

/* Sums of all lights, stage by stage, then the colour. Returns true if no lamp's highlight was computed. */
static bool light_by_stages(const WrTileJob *job, const Rays *rays, const WrSink *sink,
                            Strip *strip, Watch *watch)
{
    const Kernels *k = KERNELS_OF(job);
    const bool specular = runs(job, WR_EFFECT_SPECULAR);
    k->begin((REAL)job->scene->material.ambient, strip);
    Sums before;
    REAL *const sums[3] = { strip->dr, strip->dg, strip->db };
    open_strip(job, NULL, sums, strip, watch);
    update_colour(job, rays, strip, watch->scratch, watch);
    if (runs(job, WR_EFFECT_VARIED) || job->plan->graded) update_roughness(job, rays, strip, watch);
    stretch_strip(job->view, strip);
    const bool viewed =
        specular || reflect_of(job) || job->surround.shares > 0 || runs(job, WR_EFFECT_MIRROR);
    if (viewed || sink->bound) k->view(&VIEWED(&job->view->lit, rays), strip);
    watch_lap(watch, specular ? WR_STAGE_SPECULAR : WR_STAGE_DIFFUSE);
    if (viewed) keep_half3(job, strip->vx, strip->vy, strip->vz, strip->count, watch);
    bool dull = specular;
    for (int i = 0; i < job->view->light_count && (specular || runs(job, WR_EFFECT_DIFFUSE)); i++)
        dull &= shadowed_lamp(job, rays, &VIEWED(job->view, lights)[i], sink, strip, watch);
    if (job->plan->tint != 0) {
        k->tint((REAL)job->plan->tint, strip);
        did(watch, WR_EFFECT_MODEL);
    }
    if (runs(job, WR_EFFECT_SURROUND)) {
        if (runs(job, WR_EFFECT_OCCLUSION)) keep_sums(strip, &before);
        surround_strip(job, strip, watch);
        open_strip(job, &before, sums, strip, watch);
    }
    if (runs(job, WR_EFFECT_MIRROR)) mirror_strip(job, strip, watch);
    const WrVec3 c = colour_within(job, strip);
    k->finish((const REAL[3]){ (REAL)c.x, (REAL)c.y, (REAL)c.z }, strip);
    return dull;
}

/* The ambient light alone. */
static void ambient_alone(const WrTileJob *job, Strip *strip)
{
    const WrMaterial *m = &job->scene->material;
    const WR_T(WrKernMaterial) material = {
        (REAL)m->ambient, (REAL)0, { (REAL)m->colour.x, (REAL)m->colour.y, (REAL)m->colour.z }
    };
    KERNELS_OF(job)->ambient(&material, pictured(job), strip);
}

/* Shading of samples that no lamp reaches. */
static void ambient_strip(const WrTileJob *job, const Rays *rays, Strip *strip, Watch *watch)
{
    update_colour(job, rays, strip, watch->scratch, watch);
    ambient_alone(job, strip);
    watch_lap(watch, WR_STAGE_LIGHT);
    open_strip(job, NULL, (REAL *const[3]){ strip->cr, strip->cg, strip->cb }, strip, watch);
}

typedef struct Colours {
    REAL of[3][WR_SPAN];
} Colours;

static void keep_colours(const Strip *strip, Colours *to)
{
    const REAL *const c[3] = { strip->cr, strip->cg, strip->cb };
    for (int k = 0; k < 3; k++) memcpy(to->of[k], c[k], (size_t)strip->count * sizeof(REAL));
}

static void put_colours(const Colours *from, Strip *strip)
{
    REAL *const c[3] = { strip->cr, strip->cg, strip->cb };
    for (int k = 0; k < 3; k++) memcpy(c[k], from->of[k], (size_t)strip->count * sizeof(REAL));
}

/* One light in one pass, times its visibility, added to the ambient light times the ambient occlusion. */
static void veiled_at_once(const WrTileJob *job, WR_T(WrShadeKernel) shade, Strip *strip,
                           Watch *watch)
{
    const Kernels *kernels = KERNELS_OF(job);
    REAL share[WR_SPAN], *const c[3] = { strip->cr, strip->cg, strip->cb };
    WrSeen seen = WR_SEEN_WHOLE;
    Colours own, dark; /* own: the picture's colours, if there is one; dark: of ambient light */
    if (runs(job, WR_EFFECT_SHADOW)) {
        seen = seen_of(job, &VIEWED(job->view, lights)[0], strip, share, watch);
        watch_lap(watch, WR_STAGE_SHADOW);
    }
    const bool open = runs(job, WR_EFFECT_OCCLUSION);
    if (seen == WR_SEEN_WHOLE && !open) {
        light_at_once(job, &VIEWED(&job->view->lit, rays), shade, true, strip, watch);
        return;
    }
    if (pictured(job)) keep_colours(strip, &own);
    ambient_alone(job, strip);
    watch_lap(watch, WR_STAGE_LIGHT);
    open_strip(job, NULL, c, strip, watch);
    keep_colours(strip, &dark);
    if (seen == WR_SEEN_NOT) return;
    if (pictured(job)) put_colours(&own, strip);
    light_at_once(job, &VIEWED(&job->view->lit, rays), shade, !open, strip, watch);
    for (int k = 0; k < 3 && open; k++)
        for (int i = 0; i < strip->count; i++) c[k][i] += dark.of[k][i];
    for (int k = 0; k < 3 && seen == WR_SEEN_PART; k++)
        kernels->veil(share, dark.of[k], strip->count, c[k]);
    watch_lap(watch, WR_STAGE_SHADOW);
}

/* Lights the strip. Returns the skipped work, bits of WrRun. */
static unsigned light_strip(const WrTileJob *job, const Rays *rays, const WrSink *sink,
                            Strip *strip, Watch *watch)
{
    const WR_T(WrShadeKernel) shade = single_pass(job, rays, sink);
    if (runs(job, WR_EFFECT_DARK)) did(watch, WR_EFFECT_DARK);
    if (!shade) return light_by_stages(job, rays, sink, strip, watch) ? WR_RUN_DULL : 0;
    update_colour(job, rays, strip, watch->scratch, watch);
    stretch_strip(job->view, strip);
    if (runs(job, WR_EFFECT_SHADOW) || runs(job, WR_EFFECT_OCCLUSION))
        veiled_at_once(job, shade, strip, watch);
    else light_at_once(job, &VIEWED(&job->view->lit, rays), shade, true, strip, watch);
    return 0;
}

/* ---- early-outs ---- */

/* Early-outs for runs of samples: flat parts of the table, and samples that all lights are
   behind, however the table bends their normals. Part of pipeline_body.h. */

/* Upper bound of the slopes that the strip fetches. */
static void find_steepest(const WrTileJob *job, const Strip *strip, float steepest[2])
{
    double box[4];
    KERNELS_OF(job)->reach(strip, box);
    wr_level_box(&job->level, box[0], box[1], box[2], box[3], steepest);
}

/* True if every light certainly lies behind these samples. table: the largest slopes; NULL: n' is n. */
static bool are_behind(const WrTileJob *job, const Rays *rays, const float table[2], int step,
                       const Strip *strip)
{
    const Kernels *k = KERNELS_OF(job);
    const REAL more = (REAL)1.00001; /* sums of slopes are rounded */
    REAL steepest[2] = { 0, 0 };
    if (table) {
        steepest[0] = (REAL)table[0] * more * (REAL)fabs((double)LOOK_OF(job)->scale_u);
        steepest[1] = (REAL)table[1] * more * (REAL)fabs((double)LOOK_OF(job)->scale_v);
    }
    for (int i = 0; i < job->view->light_count; i++) {
        const WR_T(WrKernLight) *light = &VIEWED(job->view, lights)[i];
        if (table ? !k->behind_bumped(rays, light, steepest, step, strip)
                  : !k->behind(rays, light, step, strip))
            return false;
    }
    return true;
}

/* A few samples are tested first, with the slopes of the table's flattest tile: most runs that are not dark fail
   here. deferred: kernels of a surface whose tangents are not computed yet, or NULL. */
static bool is_dark(const WrTileJob *job, const Rays *rays, bool level,
                    const WR_T(WrRound) * deferred, Strip *strip)
{
    const int few = strip->count / 3 + 1;
    const bool bumped = !level && job->plan->bump != WR_BUMP_NONE;
    float table[2];
    if (!job->dark || job->view->stretched) return false;
    if (bumped && deferred) {
        if (!are_behind(job, rays, NULL, few, strip)) return false;
        deferred->tangents(&VIEWED(job->view, shape), strip);
    }
    if (!are_behind(job, rays, bumped ? job->level.gentlest : NULL, few, strip)) return false;
    if (!bumped) return are_behind(job, rays, NULL, 1, strip);
    find_steepest(job, strip, table);
    return are_behind(job, rays, table, few, strip) && are_behind(job, rays, table, 1, strip);
}

/* Records the texels that a skipped run would have fetched: after an edit there the run may need the work. */
static void note_spared(const WrTileJob *job, const Rays *rays, Strip *strip,
                        const WrTileScratch *scratch)
{
    const WrLevel *level = &job->level;
    for (int i = 0; i < strip->count; i++) {
        const double u = level->ru * (double)strip->u[i], v = level->rv * (double)strip->v[i];
        strip->tu[i] = (REAL)(level->periodic_u ? u - floor(u) : fmin(fmax(u, 0), 1));
        strip->tv[i] = (REAL)(level->periodic_v ? v - floor(v) : fmin(fmax(v, 0), 1));
    }
    note_looks(job, rays, strip, scratch);
}

/* Where the table has no slope, n' equals n to the bit. */
static bool is_level(const WrTileJob *job, const Strip *strip)
{
    float steepest[2];
    if (!job->ground || job->plan->bump == WR_BUMP_NONE) return false;
    if (runs(job, WR_EFFECT_SHADOW)) return false; /* the tangents are needed */
    find_steepest(job, strip, steepest);
    return steepest[0] == 0.0f && steepest[1] == 0.0f;
}
