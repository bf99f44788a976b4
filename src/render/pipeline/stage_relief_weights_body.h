/* stage_relief_weights_body.h - F on a mesh with masks or blended planes (surface/relief_weights.h): the table is fetched
   once for each term, and the terms are added with the slopes of their weights. Part of pipeline_body.h. */

static bool is_weighted(const WrTileJob *job)
{
    return met_whole(job) && job->scene->triangles && job->scene->triangles->weights;
}

/* The terms of a strip's samples. */
typedef struct Terms {
    WrReliefTap tap[WR_SPAN][WR_RELIEF_TAPS];
    WrReliefSum sum[WR_SPAN];
    double moments[WR_SPAN][3];
    int32_t face[WR_SPAN];
    int count[WR_SPAN]; /* of terms; 0: F is 0 */
} Terms;

static void find_terms(const WrTileJob *job, const Strip *strip, Terms *terms)
{
    for (int i = 0; i < strip->count; i++) {
        REAL share[3];
        terms->face[i] = (int32_t)face_at(&job->triangle_look, strip, i, share);
        terms->count[i] = wr_relief_taps(job->scene->triangles, terms->face[i], (double)share[1],
                                         (double)share[2], terms->tap[i]);
        terms->sum[i] = (WrReliefSum){ 0 };
        memset(terms->moments[i], 0, sizeof terms->moments[i]);
    }
}

/* The gradient on the face with these derivatives by the shares of its corners 1 and 2, kernel units. */
static VEC gradient_on_face(const WrTileJob *job, int32_t face, const double b[2])
{
    const WrTriangles *mesh = job->scene->triangles;
    WrVec3 p[3];
    for (int k = 0; k < 3; k++) {
        const float *at = mesh->corners[mesh->triangles[face].corner[k]].p;
        p[k] = v3_scale((WrVec3){ (double)at[0], (double)at[1], (double)at[2] }, job->view->scale);
    }
    const WrVec3 e1 = v3_sub(p[1], p[0]), e2 = v3_sub(p[2], p[0]), n = v3_cross(e1, e2);
    const double square = v3_dot(n, n);
    const WrVec3 g = v3_add(v3_scale(v3_cross(e2, n), b[0]), v3_scale(v3_cross(n, e1), b[1]));
    const double by = square > 0 ? 1 / square : 0;
    return (VEC){ (REAL)(g.x * by), (REAL)(g.y * by), (REAL)(g.z * by) };
}

/* Moves the samples to that term's (u,v), with the vectors from which footprints follow. False: no sample has the term. */
static bool go_to_term(const WrTileJob *job, const Terms *terms, int k, Strip *strip)
{
    bool any = false;
    for (int i = 0; i < strip->count; i++) {
        const WrReliefTap *tap = &terms->tap[i][k];
        if (k >= terms->count[i] || !(tap->weight > 0)) continue;
        const VEC n = { strip->nx[i], strip->ny[i], strip->nz[i] };
        any = true;
        strip->u[i] = (REAL)tap->u, strip->v[i] = (REAL)tap->v;
        if (!runs(job, WR_EFFECT_FILTER)) continue;
        const VEC pu = v_cross(gradient_on_face(job, terms->face[i], tap->v_b), n);
        const VEC pv = v_cross(n, gradient_on_face(job, terms->face[i], tap->u_b));
        strip->pux[i] = pu.x, strip->puy[i] = pu.y, strip->puz[i] = pu.z;
        strip->pvx[i] = pv.x, strip->pvy[i] = pv.y, strip->pvz[i] = pv.z;
    }
    return any;
}

/* Adds the covariance S of the term's slopes: J S J^T, where J turns them into those by the face's own (u,v). */
static void add_moments(const WrTileJob *job, const Strip *strip, int i, const WrReliefTap *tap,
                        int32_t face, double moments[3])
{
    double j[2][2];
    const double s[3] = { (double)strip->suu[i], (double)strip->suv[i], (double)strip->svv[i] };
    for (int c = 0; c < 2; c++) {
        WrReliefSum one = { 0 };
        wr_relief_add(&one, tap, 0, c == 0, c == 1);
        wr_relief_slopes(job->scene->triangles, face, &one, &j[0][c], &j[1][c]);
    }
    moments[0] +=
        j[0][0] * j[0][0] * s[0] + 2 * j[0][0] * j[0][1] * s[1] + j[0][1] * j[0][1] * s[2];
    moments[1] += j[0][0] * j[1][0] * s[0] + (j[0][0] * j[1][1] + j[0][1] * j[1][0]) * s[1] +
                  j[0][1] * j[1][1] * s[2];
    moments[2] +=
        j[1][0] * j[1][0] * s[0] + 2 * j[1][0] * j[1][1] * s[1] + j[1][1] * j[1][1] * s[2];
}

/* f in the unit in which its derivatives are those that the kernels use. */
static void add_term(const WrTileJob *job, Terms *terms, int k, const Strip *strip)
{
    const double unit = wr_slope_unit(job->plan->bump, job->view->scale) / job->view->scale;
    for (int i = 0; i < strip->count; i++) {
        const WrReliefTap *tap = &terms->tap[i][k];
        if (k >= terms->count[i] || !(tap->weight > 0)) continue;
        wr_relief_add(&terms->sum[i], tap, (double)strip->f[i] * unit, (double)strip->fu[i],
                      (double)strip->fv[i]);
        if (runs(job, WR_EFFECT_FILTER))
            add_moments(job, strip, i, tap, terms->face[i], terms->moments[i]);
    }
}

static void put_sums(const WrTileJob *job, const Terms *terms, Strip *strip)
{
    const double unit = wr_slope_unit(job->plan->bump, job->view->scale) / job->view->scale;
    for (int i = 0; i < strip->count; i++) {
        double fu, fv;
        wr_relief_slopes(job->scene->triangles, terms->face[i], &terms->sum[i], &fu, &fv);
        strip->f[i] = (REAL)(terms->sum[i].f / unit);
        strip->fu[i] = (REAL)fu, strip->fv[i] = (REAL)fv;
        if (!runs(job, WR_EFFECT_FILTER)) continue;
        strip->suu[i] = (REAL)terms->moments[i][0];
        strip->suv[i] = (REAL)terms->moments[i][1];
        strip->svv[i] = (REAL)terms->moments[i][2];
    }
}

/* F and its slopes, weighted where the mesh has weights. */
static void look_relief(const WrTileJob *job, const Rays *rays, Strip *strip,
                        WrTileScratch *scratch, Watch *watch)
{
    if (!is_weighted(job)) {
        look(job, rays, strip, scratch, watch);
        return;
    }
    Terms terms;
    REAL own[8][WR_SPAN];
    REAL *const kept[8] = { strip->u,   strip->v,   strip->pux, strip->puy,
                            strip->puz, strip->pvx, strip->pvy, strip->pvz };
    const size_t size = (size_t)strip->count * sizeof(REAL);
    for (int k = 0; k < 8; k++) memcpy(own[k], kept[k], size);
    find_terms(job, strip, &terms);
    for (int k = 0; k < WR_RELIEF_TAPS; k++) {
        if (!go_to_term(job, &terms, k, strip)) continue;
        look(job, rays, strip, scratch, watch);
        add_term(job, &terms, k, strip);
        for (int j = 0; j < 8; j++) memcpy(kept[j], own[j], size);
    }
    put_sums(job, &terms, strip);
}
