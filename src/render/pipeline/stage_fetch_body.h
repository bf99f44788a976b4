/* stage_fetch_body.h - heights, slopes and colours of a strip: from the formula, the table or the colour
   picture, filtered over each pixel's footprint or not. Part of pipeline_body.h. */

/* F as a formula: one point at a time, in double. */
static void look_analytic(const WrTileJob *job, Strip *strip)
{
    const double slope = wr_slope_unit(job->plan->bump, job->view->scale);
    for (int i = 0; i < strip->count; i++) {
        double f, fu, fv;
        wr_scene_height(job->scene, NULL, (double)strip->u[i], (double)strip->v[i], &f, &fu, &fv);
        strip->f[i] = (REAL)(f * job->view->scale);
        strip->fu[i] = (REAL)(fu * slope);
        strip->fv[i] = (REAL)(fv * slope);
    }
}

#ifndef WR_PIPE_DOUBLE
/* Heights in double with shading in single precision: only the fetch uses the double kernels. */
static void look_in_double(const WrTileJob *job, WrScheme scheme, Strip *strip,
                           WrTileScratch *scratch)
{
    WrStripd *wide = &scratch->wide[0];
    wide->count = strip->count;
    for (int i = 0; i < strip->count; i++) {
        wide->u[i] = (double)strip->u[i];
        wide->v[i] = (double)strip->v[i];
    }
    job->kernels_double->look[scheme](&job->look_double, wide);
    for (int i = 0; i < strip->count; i++) {
        strip->tu[i] = (float)wide->tu[i];
        strip->tv[i] = (float)wide->tv[i];
        strip->f[i] = (float)wide->f[i];
        strip->fu[i] = (float)wide->fu[i];
        strip->fv[i] = (float)wide->fv[i];
    }
}
#endif

static void look_by(const WrTileJob *job, WrScheme scheme, Strip *strip, WrTileScratch *scratch)
{
    scratch->ran |= job->looks;
#ifndef WR_PIPE_DOUBLE
    if (job->plan->precision != WR_PRECISION_SINGLE) {
        look_in_double(job, scheme, strip, scratch);
        return;
    }
#endif
#ifdef HAS_WIDE
    if (job->wide && scheme == WR_SCHEME_CENTRAL &&
        job->wide->central(LOOK_OF(job), scratch->notes.patches, strip))
        return;
#endif
    KERNELS_OF(job)->look[scheme](LOOK_OF(job), strip);
}

static void look_level0(const WrTileJob *job, Strip *strip, WrTileScratch *scratch)
{
    look_by(job, job->plan->scheme, strip, scratch);
}

/* F without slopes: `central` has the heights of `bilinear`. */
static void look_heights(const WrTileJob *job, Strip *strip, WrTileScratch *scratch)
{
    const WrScheme scheme = job->plan->scheme;
    look_by(job, scheme == WR_SCHEME_CENTRAL ? WR_SCHEME_BILINEAR : scheme, strip, scratch);
}

/* Offset of the k-th fetch of a sample along its footprint's longer side, -1/2 .. 1/2. */
static REAL along(int tap, int taps)
{
    return ((REAL)tap + (REAL)0.5) / (REAL)taps - (REAL)0.5;
}

static void tap_into(Strip *to, const Strip *from, int sample, REAL t)
{
    int k = to->count++;
    to->u[k] = from->u[sample] + t * from->long_u[sample];
    to->v[k] = from->v[sample] + t * from->long_v[sample];
    to->level[k] = from->level[sample];
}

/* Running mean and covariance of a sample's n fetches. */
typedef struct Sum {
    REAL f, fu, fv, suu, suv, svv;
} Sum;

/* Mixes a with share r of b; the distance of the two means adds to the covariance.
   S = (1 - r) Sa + r Sb + r (1 - r) d d^T, the law of total covariance with d the difference of the means. */
static Sum sum_mix(Sum a, Sum b, REAL r)
{
    REAL du = b.fu - a.fu, dv = b.fv - a.fv, k = r * ((REAL)1 - r);
    return (Sum){ a.f + r * (b.f - a.f),
                  a.fu + r * du,
                  a.fv + r * dv,
                  a.suu + r * (b.suu - a.suu) + k * du * du,
                  a.suv + r * (b.suv - a.suv) + k * du * dv,
                  a.svv + r * (b.svv - a.svv) + k * dv * dv };
}

/* A batch of fetches: each is in `near` (the table itself), in `far` (the pyramid) or, below level 1, in both,
   in order. */
typedef struct Batch {
    int count;
    int sample[WR_SPAN], tap[WR_SPAN];
    const WrPictureLook *picture; /* the picture to fetch from; NULL: heights */
    int grid;                     /* samples a side of a pixel */
} Batch;

/* Sums up a batch's fetches; leaves near and far empty. */
typedef void Flush(const WrTileJob *job, const Batch *batch, Strip *strip, WrTileScratch *scratch,
                   Watch *watch);

/* Records the texels of pyramid fetch i in the dirty regions; the sample is at x, y of the grid of k x k a
   pixel. */
static void note_far(const WrTileJob *job, int k, REAL x, REAL y, const Strip *far, int i,
                     const WrDirtyNotes *notes)
{
    const WrPyramid *pyramid = LOOK_OF(job)->pyramid;
    int level = (int)far->level[i] + 1;
    level = level < pyramid->levels ? level : pyramid->levels - 1;
    const double reach_u = 1.5 / pyramid->level[level].width + 2.0 / LOOK_OF(job)->width;
    const double reach_v = 1.5 / pyramid->level[level].height + 2.0 / LOOK_OF(job)->height;
    wr_dirty_add_box(notes, k, (double)x, (double)y, (double)far->tu[i], (double)far->tv[i],
                     reach_u, reach_v);
}

static void note_batch(const WrTileJob *job, int k, const Batch *batch, const Strip *near,
                       const Strip *far, const Strip *strip, const WrDirtyNotes *notes)
{
    int a = 0, b = 0;
    for (int at = 0; at < batch->count; at++) {
        const int i = batch->sample[at];
        const REAL level = strip->level[i], x = strip->x[i], y = strip->y[i];
        if (level < (REAL)1) {
            wr_dirty_add_box(notes, k, (double)x, (double)y, (double)near->tu[a],
                             (double)near->tv[a], 0, 0);
            a++;
        }
        if (level > (REAL)0) note_far(job, k, x, y, far, b++, notes);
    }
}

/* Adds the batch's fetches to the strip.
   Taps have equal weight: tap t is mixed with share 1 / (t + 1), a running mean. Between levels 0 and 1 the
   table and the pyramid are mixed by the level's fraction. */
static void sum_batch(const Batch *batch, const Strip *near, const Strip *far, Strip *strip)
{
    int a = 0, b = 0;
    for (int k = 0; k < batch->count; k++) {
        int i = batch->sample[k];
        REAL level = strip->level[i];
        Sum at = { 0 };
        if (level < (REAL)1) at = (Sum){ near->f[a], near->fu[a], near->fv[a], 0, 0, 0 }, a++;
        if (level > (REAL)0) {
            Sum up = { far->f[b], far->fu[b], far->fv[b], far->suu[b], far->suv[b], far->svv[b] };
            at = level < (REAL)1 ? sum_mix(at, up, level) : up;
            b++;
        }
        if (batch->tap[k] > 0) {
            Sum so_far = { strip->f[i],   strip->fu[i],  strip->fv[i],
                           strip->suu[i], strip->suv[i], strip->svv[i] };
            at = sum_mix(so_far, at, (REAL)1 / (REAL)(batch->tap[k] + 1));
        }
        strip->f[i] = at.f, strip->fu[i] = at.fu, strip->fv[i] = at.fv;
        strip->suu[i] = at.suu, strip->suv[i] = at.suv, strip->svv[i] = at.svv;
    }
}

static void flush_slopes(const WrTileJob *job, const Batch *batch, Strip *strip,
                         WrTileScratch *scratch, Watch *watch)
{
    Strip *near = NEAR_OF(scratch), *far = FAR_OF(scratch);
    const bool moments = runs(job, WR_EFFECT_SPREAD);
    if (near->count > 0) look_level0(job, near, scratch);
    watch_lap(watch, WR_STAGE_LOOK);
    if (far->count > 0) KERNELS_OF(job)->look_pyramid(LOOK_OF(job), moments, far);
    if (scratch->notes.patches)
        note_batch(job, batch->grid, batch, near, far, strip, &scratch->notes);
    sum_batch(batch, near, far, strip);
    near->count = far->count = 0;
    watch_lap(watch, WR_STAGE_PYRAMID);
}

/* Number of the strip's samples that fetch above level 0 or more than once; each is marked in `wide`. */
static int count_wide(const Strip *strip, unsigned char *wide)
{
    int count = 0;
    for (int i = 0; i < strip->count; i++) {
        wide[i] = strip->level[i] > (REAL)0 || strip->taps[i] > 1;
        count += wide[i];
    }
    return count;
}

/* Fetches along each sample's footprint.
   A long footprint is covered by `taps` fetches along its long side, each isotropic with the size of the short
   side. Fetches of all samples are queued and flushed in full strips. */
static void look_along(const WrTileJob *job, const Rays *rays, Flush *flush,
                       const WrPictureLook *picture, Strip *strip, WrTileScratch *scratch,
                       Watch *watch)
{
    Strip *near = NEAR_OF(scratch), *far = FAR_OF(scratch);
    Batch batch;
    batch.picture = picture;
    batch.grid = grid_of(job->view, rays);
    batch.count = near->count = far->count = 0;
    for (int i = 0; i < strip->count; i++)
        for (int tap = 0; tap < strip->taps[i]; tap++) {
            REAL t = strip->taps[i] > 1 ? along(tap, strip->taps[i]) : (REAL)0;
            if (strip->level[i] < (REAL)1) tap_into(near, strip, i, t);
            if (strip->level[i] > (REAL)0) tap_into(far, strip, i, t);
            batch.sample[batch.count] = i;
            batch.tap[batch.count++] = tap;
            if (batch.count < WR_SPAN) continue;
            flush(job, &batch, strip, scratch, watch);
            batch.count = 0;
        }
    if (batch.count > 0) flush(job, &batch, strip, scratch, watch);
}

/* Filtered slopes over the footprint. If no footprint of the strip is larger than a texel, the table is fetched
   directly (E17). */
static void look_filtered(const WrTileJob *job, const Rays *rays, Strip *strip,
                          WrTileScratch *scratch, Watch *watch)
{
    const Kernels *k = KERNELS_OF(job);
    did(watch, WR_EFFECT_FILTER);
    (met_whole(job) ? k->footprint_met : k->footprint)(rays, LOOK_OF(job), 1, strip);
    k->spread(LOOK_OF(job), job->plan->anisotropic, strip);
    for (int i = 0; i < strip->count; i++) strip->suu[i] = strip->suv[i] = strip->svv[i] = 0;
    const int wide = count_wide(strip, scratch->wide_of);
    watch_lap(watch, WR_STAGE_FOOTPRINT);
    scratch->wide_samples += wide;
    if (wide > 0) {
        look_along(job, rays, flush_slopes, NULL, strip, scratch, watch);
        return;
    }
    look_level0(job, strip, scratch);
    note_looks(job, rays, strip, scratch);
    watch_lap(watch, WR_STAGE_LOOK);
}

static void look(const WrTileJob *job, const Rays *rays, Strip *strip, WrTileScratch *scratch,
                 Watch *watch)
{
    if (job->plan->source == WR_SOURCE_FORMULA) {
        look_analytic(job, strip);
    } else if (runs(job, WR_EFFECT_FILTER)) {
        look_filtered(job, rays, strip, scratch, watch);
        return;
    } else {
        look_level0(job, strip, scratch);
        note_looks(job, rays, strip, scratch);
    }
    watch_lap(watch, WR_STAGE_LOOK);
}

/* ---- the colour picture --------------------------------------------------------------------------- */

typedef struct Colour {
    REAL r, g, b;
} Colour;

static Colour colour_of(const Strip *strip, int i)
{
    return (Colour){ strip->cr[i], strip->cg[i], strip->cb[i] };
}

static Colour colour_mix(Colour a, Colour b, REAL t)
{
    return (Colour){ a.r + t * (b.r - a.r), a.g + t * (b.g - a.g), a.b + t * (b.b - a.b) };
}

static void flush_colours(const WrTileJob *job, const Batch *batch, Strip *strip,
                          WrTileScratch *scratch, Watch *watch)
{
    Strip *near = NEAR_OF(scratch), *far = FAR_OF(scratch);
    const bool facets = batch->picture != &job->colour;
    if (near->count > 0) KERNELS_OF(job)->colour(&batch->picture->near, near);
    watch_lap(watch, facets ? WR_STAGE_FACETS : WR_STAGE_COLOUR);
    if (far->count > 0) KERNELS_OF(job)->colour_pyramid(FAR_LOOK(batch->picture), far);
    int a = 0, b = 0;
    for (int k = 0; k < batch->count; k++) {
        const int i = batch->sample[k], tap = batch->tap[k];
        const REAL level = strip->level[i];
        Colour at = { 0 };
        if (level < (REAL)1) at = colour_of(near, a++);
        if (level > (REAL)0) {
            const Colour up = colour_of(far, b++);
            at = level < (REAL)1 ? colour_mix(at, up, level) : up;
        }
        if (tap > 0) at = colour_mix(colour_of(strip, i), at, (REAL)1 / (REAL)(tap + 1));
        strip->cr[i] = at.r, strip->cg[i] = at.g, strip->cb[i] = at.b;
    }
    near->count = far->count = 0;
    watch_lap(watch, facets ? WR_STAGE_FACETS : WR_STAGE_TINT);
}

/* A filtered picture, with footprints in its own texels, into cr, cg, cb; unfiltered if no footprint is larger
   than a texel. Runs after the fetches of the table, whose buffers it reuses. Returns the number of samples
   above level 0; each is marked in `wide`. */
static int look_wide(const WrTileJob *job, const Rays *rays, const WrPictureLook *picture,
                     bool anisotropic, unsigned char *wide, Strip *strip, WrTileScratch *scratch,
                     Watch *watch)
{
    const Kernels *k = KERNELS_OF(job);
    const bool facets = picture != &job->colour;
    (met_whole(job) ? k->footprint_met : k->footprint)(rays, FAR_LOOK(picture), 1, strip);
    k->spread(FAR_LOOK(picture), anisotropic, strip);
    const int count = count_wide(strip, wide);
    watch_lap(watch, facets ? WR_STAGE_FACETS : WR_STAGE_TINT);
    if (count > 0) look_along(job, rays, flush_colours, picture, strip, scratch, watch);
    else k->colour(&picture->near, strip);
    watch_lap(watch, facets ? WR_STAGE_FACETS : WR_STAGE_COLOUR);
    return count;
}

/* Colour C, filtered over the footprint (E64). */
static void look_tint(const WrTileJob *job, const Rays *rays, Strip *strip, WrTileScratch *scratch,
                      Watch *watch)
{
    did(watch, WR_EFFECT_TINT);
    scratch->wide_tints += look_wide(job, rays, &job->colour, job->plan->tint_anisotropic,
                                     scratch->tint_of, strip, scratch, watch);
}

/* Fetches by the hand-written SIMD kernels (simd_kernels.h). False: there are none. */
static bool coloured_wide(const WrTileJob *job, Strip *strip)
{
#ifdef HAS_WIDE
    return job->wide && job->wide->colour(&job->colour.near, strip);
#else
    (void)job, (void)strip;
    return false;
#endif
}

/* C of the colour picture. */
static void look_colour(const WrTileJob *job, const Rays *rays, Strip *strip,
                        WrTileScratch *scratch, Watch *watch)
{
    did(watch, WR_EFFECT_COLOUR);
    if (runs(job, WR_EFFECT_TINT)) {
        look_tint(job, rays, strip, scratch, watch);
        return;
    }
    if (!coloured_wide(job, strip)) KERNELS_OF(job)->colour(&job->colour.near, strip);
    watch_lap(watch, WR_STAGE_COLOUR);
}

/* True if C varies over the surface. */
static bool pictured(const WrTileJob *job)
{
    return runs(job, WR_EFFECT_COLOUR) || runs(job, WR_EFFECT_GRAIN);
}

static void note_grain(const WrTileJob *job, Watch *watch)
{
    if (runs(job, WR_EFFECT_OCTAVES)) did(watch, WR_EFFECT_OCTAVES);
    if (runs(job, WR_EFFECT_FADED)) did(watch, WR_EFFECT_FADED);
    watch_lap(watch, WR_STAGE_GRAIN);
}

/* C of the colour picture, of the solid texture at P, or of both. */
static void update_colour(const WrTileJob *job, const Rays *rays, Strip *strip,
                          WrTileScratch *scratch, Watch *watch)
{
    const bool over = runs(job, WR_EFFECT_COLOUR);
    if (over) look_colour(job, rays, strip, scratch, watch);
    if (!runs(job, WR_EFFECT_GRAIN)) return;
    KERNELS_OF(job)->grain(rays, GRAIN_OF(job), over, strip);
    did(watch, WR_EFFECT_GRAIN);
    note_grain(job, watch);
}

/* Roughness and metalness from pictures. The fetches pass through the colour buffers. */
static void look_facets(const WrTileJob *job, const Rays *rays, Strip *strip,
                        WrTileScratch *scratch, Watch *watch)
{
    REAL own[3][WR_SPAN], *const c[3] = { strip->cr, strip->cg, strip->cb };
    REAL *const to[WR_FACET_KINDS] = { strip->rough, strip->metal };
    const size_t size = (size_t)strip->count * sizeof(REAL);
    unsigned char wide[WR_SPAN];
    for (int k = 0; k < 3; k++) memcpy(own[k], c[k], size);
    for (int k = 0; k < WR_FACET_KINDS; k++) {
        const WrPictureLook *picture = &job->facets[k];
        if (!picture->near.rgba) continue;
        if (job->plan->facets_filtered)
            look_wide(job, rays, picture, job->plan->facets_anisotropic, wide, strip, scratch,
                      watch);
        else KERNELS_OF(job)->colour(&picture->near, strip);
        memcpy(to[k], strip->cr, size);
    }
    for (int k = 0; k < 3; k++) memcpy(c[k], own[k], size);
    did(watch, WR_EFFECT_FACETS);
    watch_lap(watch, WR_STAGE_FACETS);
}

/* Roughness and metalness of each sample. */
static void update_roughness(const WrTileJob *job, const Rays *rays, Strip *strip, Watch *watch)
{
    const double *by = job->scene->grain.roughness;
    for (int i = 0; i < strip->count; i++) {
        strip->rough[i] = (REAL)job->rough;
        strip->metal[i] = (REAL)job->scene->material.metalness;
    }
    if (!runs(job, WR_EFFECT_VARIED)) return;
    did(watch, WR_EFFECT_VARIED);
    if (runs(job, WR_EFFECT_FACETS)) look_facets(job, rays, strip, watch->scratch, watch);
    if (job->facets[WR_FACET_ROUGHNESS].near.rgba || !job->grain_roughens) return;
    KERNELS_OF(job)->grain_rough(rays, GRAIN_OF(job), (REAL)by[0], (REAL)by[1], strip);
    note_grain(job, watch);
}

/* n' bent by the heights of the solid texture. */
static void emboss(const WrTileJob *job, const Rays *rays, Strip *strip, Watch *watch)
{
    KERNELS_OF(job)->grain_bump(rays, GRAIN_OF(job), strip);
    did(watch, WR_EFFECT_EMBOSSED);
    note_grain(job, watch);
}
