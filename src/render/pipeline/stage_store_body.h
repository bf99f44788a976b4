/* stage_store_body.h - storage of a finished strip, as floats or as 8-bit codes. Part of pipeline_body.h. */

/* Stores the colours of neighbouring samples; returns the number that were empty before. */
static int store_run(const Strip *strip, float *restrict out)
{
    int fresh = 0;
    for (int i = 0; i < strip->count; i++) {
        const WrSampleColour colour = { (float)strip->cr[i], (float)strip->cg[i],
                                        (float)strip->cb[i], 1.0f };
        fresh += out[4 * i + 3] == 0.0f;
        memcpy(out + 4 * i, &colour, sizeof colour);
    }
    return fresh;
}

static int plain_codes(const WrTileJob *job, const Strip *strip, uint32_t *to)
{
#ifdef HAS_WIDE
    if (job->wide_codes) return job->wide_codes(job->coder.bins, strip, job->grey, to);
#endif
    return KERNELS_OF(job)->codes(job->coder.bins, strip, to);
}

/* Encodes a strip's colours; returns the number of non-finite values. */
static int64_t make_codes(const WrTileJob *job, const Strip *strip, uint32_t *to)
{
    const WrBehind nothing = { 0 };
    float rgba[WR_SPAN][4];
    if (job->coder.tone.plain) return plain_codes(job, strip, to);
    for (int i = 0; i < strip->count; i++) {
        rgba[i][0] = (float)strip->cr[i];
        rgba[i][1] = (float)strip->cg[i];
        rgba[i][2] = (float)strip->cb[i];
        rgba[i][3] = 1.0f;
    }
    return wr_code_row(&job->coder, &nothing, 0, strip->count, rgba[0], to);
}

/* Stores codes. Alpha is 0 where nothing is stored yet. sink->once: they go directly to the picture. */
static void store_codes(const WrTileJob *job, const Strip *strip, bool run, const WrSink *sink,
                        WrTileScratch *scratch)
{
    uint32_t codes[WR_SPAN], *restrict out = sink->codes;
    const bool direct = sink->once && run;
    const int first = strip->index[0];
    uint32_t *to = direct ? out + first : codes;
    int fresh = 0;
    if (sink->once && !scratch->behind)
        wr_tile_behind_strip(job, sink, direct ? first : 0, direct ? first + strip->count : 0,
                             scratch);
    scratch->not_finite += make_codes(job, strip, to);
    for (int i = 0; i < strip->count && !direct; i++) {
        fresh += out[strip->index[i]] >> 24 == 0;
        out[strip->index[i]] = codes[i];
    }
    scratch->covered += sink->once ? strip->count : fresh;
}

/* Stores a finished strip at its samples' positions. */
static void store(const WrTileJob *job, const WrSink *sink, const Strip *strip,
                  WrTileScratch *scratch)
{
    const int last = strip->count - 1;
    const bool run = strip->index[last] - strip->index[0] == last;
    if (sink->codes) store_codes(job, strip, run, sink, scratch);
    if (sink->rgba && run) scratch->covered += store_run(strip, sink->rgba + 4 * strip->index[0]);
    for (int i = 0; i < strip->count && sink->rgba && !run; i++) {
        float *out = sink->rgba + 4 * strip->index[i];
        out[0] = (float)strip->cr[i];
        out[1] = (float)strip->cg[i];
        out[2] = (float)strip->cb[i];
        scratch->covered += out[3] == 0.0f;
        out[3] = 1.0f;
    }
    for (int i = 0; i < strip->count && sink->normals; i++) {
        float *out = sink->normals + 3 * strip->index[i];
        out[0] = (float)strip->bx[i];
        out[1] = (float)strip->by[i];
        out[2] = (float)strip->bz[i];
    }
    for (int i = 0; i < strip->count && sink->bound; i++)
        sink->bound[strip->index[i]] = (float)strip->bound[i];
}
