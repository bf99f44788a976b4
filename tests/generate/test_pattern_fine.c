/* Patterns in a coarse table against averages of the same patterns eight times as fine. */
#include "test.h"

#include "generate_help.h"

#define SIDE 96
#define FINE 8

/* Lengths in texels grow with the table. Finer features (a rough surface, wood, displaced edges) depend on the number
 * of texels, so the two tables would differ. */
static WrField *made_at(const WrGenerator *g, int scale)
{
    static const char *const without[] = { "rough", "wood", "wobble", "jagged" };
    WrParamValue values[WR_GENERATOR_PARAMS];
    usual_values(g, values);
    for (int i = 0; g->params[i].name; i++) {
        for (size_t k = 0; k < sizeof without / sizeof *without; k++)
            if (strcmp(g->params[i].name, without[k]) == 0) values[i].number[0] = 0.0;
        if (g->params[i].unit && strcmp(g->params[i].unit, "texels") == 0)
            values[i].number[0] *= scale;
    }
    WrField *like = table_of(SIDE * scale, SIDE * scale), *f = made(g, values, like, NULL, false);
    wr_field_free(like);
    return f;
}

/* RMS difference from the mean of each texel's FINE x FINE, relative to the range. */
typedef struct Errors {
    double filtered, sampled; /* of the coarse table; of the fine texel nearest to the centre */
} Errors;

static Errors errors_of(const WrField *coarse, const WrField *fine)
{
    float low, high;
    double filtered = 0.0, sampled = 0.0;
    wr_field_range(fine, &low, &high);
    for (int j = 0; j < SIDE; j++)
        for (int i = 0; i < SIDE; i++) {
            double mean = 0.0, at;
            for (int k = 0; k < FINE * FINE; k++)
                mean += (double)wr_field_get(fine, i * FINE + k % FINE, j * FINE + k / FINE);
            mean /= FINE * FINE;
            at = (double)wr_field_get(fine, i * FINE + FINE / 2, j * FINE + FINE / 2);
            filtered += pow((double)wr_field_get(coarse, i, j) - mean, 2.0);
            sampled += pow(at - mean, 2.0);
        }
    double range = (double)high - (double)low;
    return (Errors){ sqrt(filtered) / SIDE / range, sqrt(sampled) / SIDE / range };
}

/* All are closer to the mean of a texel than a sample at its centre, much closer where an edge is filtered in closed
 * form. Voronoi's ridges, and crossings of scales and scratches, are less smooth: only closer. */
static void a_texel_is_the_mean_of_eight_by_eight_samples_rather_than_one(void **state)
{
    (void)state;
    for (const WrGenerator *g = wr_patterns; g->family; g++) {
        WrField *coarse = made_at(g, 1), *fine = made_at(g, FINE);
        Errors e = errors_of(coarse, fine);
        if (!(e.filtered < 0.6 * e.sampled && e.filtered < 0.025))
            fail_msg("%s: %g of the range from the mean, a sample %g", g->name, e.filtered,
                     e.sampled);
        wr_field_free(coarse);
        wr_field_free(fine);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_texel_is_the_mean_of_eight_by_eight_samples_rather_than_one),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
