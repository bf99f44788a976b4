/* pipe_known_body.h - what light looks at of a strip's samples, noted, and where what they see of lamps is kept (steady.h). A
   part of pipe_body.h. */

/* The strip's numbers of a group, so many, into `out`. */
static int numbers_of(Strip *s, WrSteadyGroup group, REAL *out[6])
{
    REAL *const all[][6] = { [WR_STEADY_BENT] = { s->bx, s->by, s->bz },
                             [WR_STEADY_POINTS] = { s->px, s->py, s->pz },
                             [WR_STEADY_PLACES] = { s->u, s->v },
                             [WR_STEADY_NORMALS] = { s->nx, s->ny, s->nz },
                             [WR_STEADY_TANGENTS] = { s->pux, s->puy, s->puz, s->pvx, s->pvy,
                                                      s->pvz },
                             [WR_STEADY_SPREAD] = { s->ex, s->ey, s->ez, s->see, s->sef, s->sff },
                             [WR_STEADY_TRIANGLE] = { NULL } };
    int count = 0;
    while (count < 6 && all[group][count]) {
        out[count] = all[group][count];
        count++;
    }
    return count;
}

/* The sample of the grid that sample i of the strip is. */
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
    const WrSteady *steady = job->noting ? job->noting : job->steady;
    return wr_steady_place(steady, sample_x(s, i), sample_y(s, i));
}

/* Nothing is known any more of what the sample sees of lamps: it shows a nearer object than before. */
static void forget_shares(const WrTileJob *job, size_t place)
{
    for (int i = 0; i < job->view->light_count && job->lamps; i++) {
        const WrSteadyLamp *lamp = &job->lamps[i];
        if (lamp->cast) lamp->cast[place] = -1;
        if (lamp->relief) lamp->relief[place] = -1;
    }
}

/* All that light looks at, before it does. */
static void note_known(const WrTileJob *job, Strip *strip)
{
    const WrSteady *steady = job->noting;
    size_t at[WR_SPAN];
    int done = 0;
    for (int i = 0; i < strip->count; i++) {
        const int x = sample_x(strip, i), y = sample_y(strip, i);
        const size_t place = wr_steady_place(steady, x, y);
        at[i] = wr_steady_at(steady, x, y);
        if (steady->owner[place]) forget_shares(job, place);
        steady->owner[place] = (unsigned char)(job->object + 1);
    }
    for (int g = 0; g < WR_STEADY_GROUPS; g++) {
        REAL *from[6];
        if (!(steady->groups & WR_STEADY_BIT(g))) continue;
        const int count = numbers_of(strip, (WrSteadyGroup)g, from);
        for (int k = 0; k < count; k++, done++)
            for (int i = 0; i < strip->count; i++)
                steady->numbers[at[i] + (size_t)done * WR_STEADY_BLOCK] = (float)from[k][i];
        if (g != WR_STEADY_TRIANGLE) continue;
        for (int i = 0; i < strip->count; i++) /* whole numbers below 2^24, as rasters have them */
            steady->numbers[at[i] + (size_t)done * WR_STEADY_BLOCK] = (float)strip->triangle[i];
        done++;
    }
}
