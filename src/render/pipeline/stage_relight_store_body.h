/* stage_relight_store_body.h - writing of a strip's samples to the relight cache (relight_cache.h). Part of
   pipeline_body.h. */

/* Arrays of the strip that belong to a group, into `out`; returns their number. */
static int numbers_of(Strip *s, WrRelightGroup group, REAL *out[6])
{
    REAL *const all[][6] = { [WR_RELIGHT_BENT] = { s->bx, s->by, s->bz },
                             [WR_RELIGHT_POINTS] = { s->px, s->py, s->pz },
                             [WR_RELIGHT_PLACES] = { s->u, s->v },
                             [WR_RELIGHT_NORMALS] = { s->nx, s->ny, s->nz },
                             [WR_RELIGHT_TANGENTS] = { s->pux, s->puy, s->puz, s->pvx, s->pvy,
                                                       s->pvz },
                             [WR_RELIGHT_SPREAD] = { s->ex, s->ey, s->ez, s->see, s->sef, s->sff },
                             [WR_RELIGHT_TRIANGLE] = { NULL } };
    int count = 0;
    while (count < 6 && all[group][count]) {
        out[count] = all[group][count];
        count++;
    }
    return count;
}

/* Grid position of sample i of the strip. */
static int sample_x(const Strip *s, int i)
{
    return (int)(s->x[i] + (REAL)0.5);
}

static int sample_y(const Strip *s, int i)
{
    return (int)(s->y[i] + (REAL)0.5);
}

static size_t share_place(const WrTileJob *job, const Strip *s, int i)
{
    const WrRelight *relight = job->noting ? job->noting : job->relight;
    return wr_relight_place(relight, sample_x(s, i), sample_y(s, i));
}

/* Marks the lamps' visibility at that position as unknown: it now shows a nearer object. */
static void forget_shares(const WrTileJob *job, size_t place)
{
    for (int i = 0; i < job->view->light_count && job->lamps; i++) {
        const WrRelightLamp *lamp = &job->lamps[i];
        if (lamp->cast) lamp->cast[place] = -1;
        if (lamp->relief) lamp->relief[place] = -1;
    }
}

/* Stores all inputs of shading, before it runs. */
static void note_known(const WrTileJob *job, Strip *strip)
{
    const WrRelight *relight = job->noting;
    size_t at[WR_SPAN];
    int done = 0;
    for (int i = 0; i < strip->count; i++) {
        const int x = sample_x(strip, i), y = sample_y(strip, i);
        const size_t place = wr_relight_place(relight, x, y);
        at[i] = wr_relight_at(relight, x, y);
        if (relight->owner[place]) forget_shares(job, place);
        relight->owner[place] = (unsigned char)(job->object + 1);
    }
    for (int g = 0; g < WR_RELIGHT_GROUPS; g++) {
        REAL *from[6];
        if (!(relight->groups & WR_RELIGHT_BIT(g))) continue;
        const int count = numbers_of(strip, (WrRelightGroup)g, from);
        for (int k = 0; k < count; k++, done++)
            for (int i = 0; i < strip->count; i++)
                relight->numbers[at[i] + (size_t)done * WR_RELIGHT_BLOCK] = (float)from[k][i];
        if (g != WR_RELIGHT_TRIANGLE) continue;
        for (int i = 0; i < strip->count; i++) /* whole numbers below 2^24, as in the rasters */
            relight->numbers[at[i] + (size_t)done * WR_RELIGHT_BLOCK] = (float)strip->triangle[i];
        done++;
    }
}
