/* stage_light_body.h - lighting of a strip: a single light in one pass, several stage by stage. Part of
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
   (HC153). */
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
