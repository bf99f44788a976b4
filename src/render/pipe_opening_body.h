/* pipe_opening_body.h - ambient light and that of surroundings, as much as the relief leaves open (render/opening.h). A part
   of pipe_body.h. */

/* How open the table is at u and v of the patch. */
static REAL open_at(const WrTileJob *job, REAL u, REAL v)
{
    const WrOpeningTable *t = job->opening;
    int column[2], row[2];
    const REAL right = texel_of((REAL)job->look_double.ru * u, t->width, column);
    const REAL down = texel_of(-(REAL)job->look_double.rv * v, t->height, row);
    const float *upper = t->open + (size_t)row[0] * (size_t)t->width;
    const float *lower = t->open + (size_t)row[1] * (size_t)t->width;
    const REAL a = (REAL)upper[column[0]], b = (REAL)upper[column[1]];
    const REAL c = (REAL)lower[column[0]], d = (REAL)lower[column[1]];
    const REAL high = a + right * (b - a), low = c + right * (d - c);
    return high + down * (low - high);
}

/* What was added to the first of the sums since `before`, NULL: since there was nothing, is kept as far as the sky is open. */
static void open_strip(const WrTileJob *job, const Sums *before, REAL *const to[3], Strip *s,
                       Watch *watch)
{
    if (!runs(job, WR_EFFECT_OCCLUSION)) return;
    for (int i = 0; i < s->count; i++) {
        const REAL open = open_at(job, s->u[i], s->v[i]);
        for (int k = 0; k < 3; k++) {
            const REAL from = before ? before->of[k][i] : (REAL)0;
            to[k][i] = from + open * (to[k][i] - from);
        }
    }
    did(watch, WR_EFFECT_OCCLUSION);
    watch_lap(watch, WR_STAGE_OCCLUSION);
}
