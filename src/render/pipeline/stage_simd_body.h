/* stage_simd_body.h - dispatch of rows to fused SIMD kernels (simd_kernels.h). Part of pipeline_body.h. */

#ifdef HAS_WIDE
/* True if the lamp certainly reaches some sample, however far others are bent. First, middle and last sample
   only: if one is lit, the run is not dark and the dark test is omitted; if none is, that test decides. */
static bool lit_somewhere(const WrTileJob *job, const Strip *strip)
{
    const WrKernLight *light = job->view->lights;
    const float *l = light->where, off = light->point ? job->view->shape.value[0] : 0.0f;
    bool any = false;
    for (int k = 0; k < 3; k++) {
        const int i = k * (strip->count - 1) / 2;
        any |= strip->nx[i] * l[0] + strip->ny[i] * l[1] + strip->nz[i] * l[2] > off;
    }
    return any;
}

/* Level 0 reads single texels, higher levels squares of 2^level texels: each has its own box for later edits. */
static void note_filtered(const WrTileJob *job, const Rays *rays, const Strip *strip,
                          const WrDirtyNotes *notes)
{
    const int k = grid_of(job->view, rays);
    for (int i = 0; i < strip->count; i++) {
        const REAL x = strip->x[i], y = strip->y[i];
        if (strip->level[i] < (REAL)1)
            wr_dirty_add_box(notes, k, (double)x, (double)y, (double)strip->tu[i],
                             (double)strip->tv[i], 0, 0);
        if (strip->level[i] > (REAL)0) note_far(job, k, x, y, strip, i, notes);
    }
}

/* Slopes over the footprint, as look_filtered. */
static void filter_wide(const WrTileJob *job, const Rays *rays, REAL gx, REAL gy, Strip *strip,
                        WrTileScratch *scratch, Watch *watch)
{
    const int wide = job->wide->footprint(rays, &job->view->shape, LOOK_OF(job), gx, gy, strip);
    did(watch, WR_EFFECT_FILTER);
    watch_lap(watch, WR_STAGE_FOOTPRINT);
    scratch->wide_samples += wide;
    if (wide == 0) {
        look_level0(job, strip, scratch);
        note_looks(job, rays, strip, scratch);
        watch_lap(watch, WR_STAGE_LOOK);
        return;
    }
    scratch->ran |= job->looks;
    job->wide->filtered(LOOK_OF(job), strip);
    if (scratch->notes.patches) note_filtered(job, rays, strip, &scratch->notes);
    watch_lap(watch, WR_STAGE_PYRAMID);
}

/* Lights a run by the slopes of the table. Returns the skipped work, bits of WrRun.
   Order: the dark test first, because fetching slopes is the most expensive part; then slopes, colour, light.
   If the fused kernel is not applicable, n' is stored and light_at_once finishes. */
static unsigned light_bumped(const WrTileJob *job, const Rays *rays, REAL gx, REAL gy,
                             const WrSink *sink, Strip *strip, WrTileScratch *scratch, Watch *watch)
{
    const WrShapef *shape = &job->view->shape;
    const LampMatter m = lamp_matter(job, true);
    const bool level = is_level(job, strip);
    const bool lit = !job->dark || lit_somewhere(job, strip);
    if (!lit || job->view->lights->point) job->wide->points(shape, strip);
    const unsigned spared = spared_of(job, rays, level, lit, round_of(job), strip, scratch, watch);
    bool dark;
    if (spared & WR_RUN_DARK) {
        ambient_strip(job, rays, strip, watch);
        return spared;
    }
    if (!level) {
        if (runs(job, WR_EFFECT_FILTER)) filter_wide(job, rays, gx, gy, strip, scratch, watch);
        else look(job, rays, strip, scratch, watch);
        scratch->ran |= normal_effects[WR_BUMP_BLINN];
        did(watch, WR_EFFECT_TANGENTS);
    }
    update_colour(job, rays, strip, scratch, watch);
    if (job->wide->sphere_light(rays, shape, job->view->lights, &m.shine, &m.material, gx, gy,
                                pictured(job), !level, &dark, strip)) {
        note_light(job, watch);
        return spared;
    }
    job->wide->points(shape, strip);
    if (level) job->kernels->bump[WR_BUMP_NONE](rays, strip);
    else job->kernels->bend[WR_INVERT_SPHERE](rays, shape, strip);
    watch_lap(watch, WR_STAGE_BUMP);
    light_at_once(job, rays, single_pass(job, rays, sink), true, strip, watch);
    return spared;
}

/* Skipped work of a run that is dark, or not; bits of WrRun. */
static unsigned lit_plain(const WrTileJob *job, bool dark, Watch *watch)
{
    if (runs(job, WR_EFFECT_DARK)) did(watch, WR_EFFECT_DARK);
    if (!dark || !job->dark) note_light(job, watch);
    watch_lap(watch, WR_STAGE_LIGHT);
    return dark && job->dark ? WR_RUN_DARK : 0;
}

/* balls is parallel to view->grids; rays is one of those grids' rays. */
static const WrSphereRows *ball_of(const WrTileJob *job, const Rays *rays)
{
    const WrView *view = job->view;
    int i = 0;
    while (i + 1 < view->grid_count && &VIEWED(&view->grids[i], rays) != rays) i++;
    return &job->balls[i];
}

/* A row without bumps, in one call. False: not applicable.
   RED: all channels are equal, one is computed. LATER: light now, colours after the fetch. ALL: finished
   colours. */
static bool smooth_row(const WrTileJob *job, const Rays *rays, REAL gx, REAL gy, int count,
                       const WrSink *sink, WrTileScratch *scratch, Watch *watch)
{
    const LampMatter m = lamp_matter(job, true);
    const WrKernLight *light = job->view->lights;
    const bool alike = job->grey && job->wide_codes && job->coder.tone.plain && !sink->rgba;
    const WrWidePaint how = pictured(job) ? WR_WIDE_LATER : alike ? WR_WIDE_RED : WR_WIDE_ALL;
    Strip *strip = &scratch->strip;
    bool dark = false;
    if (!job->wide->smooth(ball_of(job, rays), rays, light, &m.shine, &m.material, gx, gy, count,
                           how, &dark, strip))
        return false;
    if (scratch->notes.patches) note_places(job, sink, true, gx, gy, strip);
    watch_lap(watch, WR_STAGE_VISIBILITY);
    if (strip->count == 0) return true;
    did(watch, WR_EFFECT_STEADY);
    if (how == WR_WIDE_LATER) {
        did(watch, WR_EFFECT_PARAMETERS);
        update_colour(job, rays, strip, scratch, watch);
        job->wide->paint(rays, light, &m.shine, &m.material, strip);
    }
    put_strip(job, rays, lit_plain(job, dark, watch), sink, strip, scratch, watch);
    return true;
}

/* Lights a run by n alone: darkness follows from the light itself. */
static unsigned light_plain(const WrTileJob *job, const Rays *rays, REAL gx, REAL gy, Strip *strip,
                            WrTileScratch *scratch, Watch *watch)
{
    const LampMatter m = lamp_matter(job, true);
    bool dark = false;
    update_colour(job, rays, strip, scratch, watch);
    if (job->view->lights->point) job->wide->points(&job->view->shape, strip);
    job->wide->sphere_light(rays, &job->view->shape, job->view->lights, &m.shine, &m.material, gx,
                            gy, pictured(job), false, &dark, strip);
    return lit_plain(job, dark, watch);
}

/* A row of a sphere under one lamp. False: the stages do the work. */
static bool wide_row(const WrTileJob *job, const Rays *rays, REAL gx, REAL gy, int count,
                     const WrSink *sink, WrTileScratch *scratch, Watch *watch)
{
    const bool mapped = runs(job, WR_EFFECT_PARAMETERS), bumped = job->plan->bump != WR_BUMP_NONE;
    Strip *strip = &scratch->strip;
    if (!job->wide_sphere || !lit(sink) || sink->normals || job->noting || sink->uv ||
        sink->nearest || sink->bound)
        return false;
    if (mapped == pictured(job) && !bumped &&
        smooth_row(job, rays, gx, gy, count, sink, scratch, watch))
        return true;
    if (!job->wide->sphere(ball_of(job, rays), rays, &job->view->shape, gx, gy, count, mapped,
                           strip))
        return false;
    if (scratch->notes.patches) note_places(job, sink, true, gx, gy, strip);
    watch_lap(watch, WR_STAGE_VISIBILITY);
    if (strip->count == 0) return true;
    if (mapped) did(watch, WR_EFFECT_PARAMETERS);
    did(watch, WR_EFFECT_STEADY);
    const unsigned spared = bumped ? light_bumped(job, rays, gx, gy, sink, strip, scratch, watch)
                                   : light_plain(job, rays, gx, gy, strip, scratch, watch);
    put_strip(job, rays, spared, sink, strip, scratch, watch);
    return true;
}

/* Points, u and v of a row of a sphere, for any shading. False: the stages compute them. */
static bool met_wide(const WrTileJob *job, const Rays *rays, REAL gx, REAL gy, int count,
                     Strip *strip)
{
    const WrShapef *shape = &job->view->shape;
    if (!job->wide_met || !job->wide->sphere(NULL, rays, shape, gx, gy, count,
                                             runs(job, WR_EFFECT_PARAMETERS), strip))
        return false;
    job->wide->points(shape, strip);
    return true;
}

/* True if no effect outside `these` runs. */
static bool runs_only(const WrPlan *plan, WrEffects these)
{
    for (int e = 0; e < WR_EFFECT_COUNT; e++)
        if (wr_plan_runs(plan, (WrEffect)e) && !(these >> e & 1)) return false;
    return true;
}

/* Equal channels stay equal through every stage only if light and material are both grey. */
static bool is_grey(const WrTileJob *job)
{
    const WrVec3 own = job->scene->material.colour;
    const float *rgb = job->view->lights->rgb;
    return own.x == own.y && own.x == own.z && rgb[0] == rgb[1] && rgb[0] == rgb[2];
}

/* True if these loops support the plan's filtered slopes. */
static bool filters_at_once(const WrTileJob *job)
{
    const WrPlan *plan = job->plan;
    return !plan->anisotropic && plan->scheme == WR_SCHEME_CENTRAL &&
           plan->precision == WR_PRECISION_SINGLE && job->wide->filters(LOOK_OF(job));
}

/* The effects that fused kernels implement; any other sends the row to the stages. */
#define E(name) WR_EFFECT_BIT(WR_EFFECT_##name)
static const WrEffects at_once = E(DIFFUSE) | E(SPECULAR) | E(COLOUR) | E(BUMP) | E(GRADIENT) |
                                 E(WIDE) | E(SAMPLES) | E(PERSPECTIVE) | E(AGAIN) | E(STEADY) |
                                 E(BESIDE) | E(PARAMETERS) | E(TANGENTS) | E(DARK) | E(GROUND);
static const WrEffects geometry =
    E(INVARIANT) | E(EXACT) | E(CURVATURE) | E(FILTER) | E(BACK) | E(DEPTH) | E(NEWTON);
#undef E

bool wr_pipe_at_once(const WrPlan *plan)
{
    return plan->inversion == WR_INVERT_SPHERE && wr_plan_runs(plan, WR_EFFECT_SPECULAR) &&
           runs_only(plan, at_once) && (plan->bump == WR_BUMP_NONE || plan->bump == WR_BUMP_BLINN);
}

void wr_pipe_wide(WrTileJob *job)
{
    const LampMatter m = lamp_matter(job, true);
    const WrBumpMode bump = job->plan->bump;
    const WrKernLight *lamp = job->view->lights;
    job->wide_sphere = job->wide_met = job->grey = false;
    if (!job->wide) { /* exact: all channels are computed alike */
        job->grey = job->view->light_count == 1 && is_grey(job) && !runs(job, WR_EFFECT_COLOUR) &&
                    runs_only(job->plan, at_once | geometry);
        return;
    }
    const WrEffects filtered = filters_at_once(job) ? WR_EFFECT_BIT(WR_EFFECT_FILTER) : 0;
    job->wide_met = job->plan->inversion == WR_INVERT_SPHERE && job->view->cull &&
                    !job->view->stretched && !job->dice && !job->triangles &&
                    !runs(job, WR_EFFECT_PARALLAX);
    if (job->view->light_count != 1 || !runs(job, WR_EFFECT_SPECULAR)) return;
    if (!job->wide->narrow(lamp, &m.shine)) return;
    job->wide_sphere = job->wide_met && !job->map && runs_only(job->plan, at_once | filtered) &&
                       (bump == WR_BUMP_NONE || bump == WR_BUMP_BLINN);
    for (int i = 0; i < job->view->grid_count && job->wide_sphere; i++)
        wr_sphere_rows_make(&job->balls[i], &job->view->grids[i].rays, &job->view->shape, lamp);
    job->grey =
        is_grey(job) && !runs(job, WR_EFFECT_COLOUR) && runs_only(job->plan, at_once | geometry);
}
#else
static bool wide_row(const WrTileJob *job, const Rays *rays, REAL gx, REAL gy, int count,
                     const WrSink *sink, WrTileScratch *scratch, Watch *watch)
{
    (void)job, (void)rays, (void)gx, (void)gy, (void)count, (void)sink, (void)scratch, (void)watch;
    return false;
}

static bool met_wide(const WrTileJob *job, const Rays *rays, REAL gx, REAL gy, int count,
                     const Strip *strip)
{
    (void)job, (void)rays, (void)gx, (void)gy, (void)count, (void)strip;
    return false;
}
#endif
