/* stage_unlit_body.h - early-outs for runs of samples: flat parts of the table, and samples that all lights are
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
