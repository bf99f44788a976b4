/* Quality of the moving patch: finer if the time allows, and stable. */
#include "test.h"

#include "ui/patch/preview/moving.h"

#define VIEW 400000.0 /* pixels */
#define ALLOWED 0.016

/* A simulated machine with a time per pixel for each mode, with random variation. */
typedef struct Machine {
    double seconds[WR_MOVING_WAYS], wobble;
    TestRandom random;
} Machine;

/* Run that many pictures; returns the changes of the mode, and counts late pictures. */
static int run(WrMoving *moving, Machine *machine, int pictures, int *late)
{
    int changes = 0;
    *late = 0;
    for (int i = 0; i < pictures; i++) {
        const WrMovingWay way = moving->way;
        const double pixels = VIEW * moving->scale * moving->scale;
        const double noise = 1 + machine->wobble * (2 * test_random(&machine->random) - 1);
        const double seconds = machine->seconds[way] * noise * pixels;
        *late += seconds > ALLOWED;
        wr_moving_learn(moving, seconds, pixels, VIEW, ALLOWED);
        assert_true(moving->scale >= WR_MOVING_COARSEST && moving->scale <= 1);
        assert_true(moving->way == WR_MOVING_POINT || moving->scale == 1);
        changes += moving->way != way;
    }
    return changes;
}

static Machine machine_of(double point, double edges, double grid)
{
    return (Machine){ { point / VIEW, edges / VIEW, grid / VIEW }, 0.1, { 3 } };
}

static void the_finest_that_the_time_allows_is_found(void **state)
{
    (void)state;
    static const struct {
        double point, edges, grid;
        WrMovingWay way;
        bool whole; /* the view's size */
    } cases[] = {
        { 0.002, 0.003, 0.007, WR_MOVING_GRID, true },
        { 0.005, 0.008, 0.020, WR_MOVING_EDGES, true },
        { 0.005, 0.018, 0.020, WR_MOVING_POINT, true },
        { 0.012, 0.020, 0.045, WR_MOVING_POINT, true },
        { 0.060, 0.110, 0.240, WR_MOVING_POINT, false },
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        int late;
        WrMoving moving = { .scale = 0.4 };
        Machine machine = machine_of(cases[i].point, cases[i].edges, cases[i].grid);
        run(&moving, &machine, 60, &late);
        if (moving.way != cases[i].way)
            fail_msg("case %d: %s", (int)i, wr_moving_names[moving.way]);
        assert_true((moving.scale == 1) == cases[i].whole);
        /* In the steady state hardly any picture is late, and the mode is constant. */
        const int changes = run(&moving, &machine, 600, &late);
        if (changes > 12 || (cases[i].whole && late > 40))
            fail_msg("case %d: %d changes, %d late", (int)i, changes, late);
    }
}

static void a_machine_that_becomes_busy_is_followed_down_and_up_again(void **state)
{
    (void)state;
    int late;
    WrMoving moving = { .scale = 0.4 };
    Machine quick = machine_of(0.002, 0.003, 0.007), busy = machine_of(0.010, 0.019, 0.040);
    run(&moving, &quick, 60, &late);
    assert_int_equal(moving.way, WR_MOVING_GRID);
    run(&moving, &busy, 12, &late);
    assert_true(late < 10);
    assert_int_equal(moving.way, WR_MOVING_POINT);
    run(&moving, &quick, 120, &late);
    assert_int_equal(moving.way, WR_MOVING_GRID);
}

/* Between two modes: it does not oscillate with variations of the clock. */
static void near_the_bound_the_way_stays(void **state)
{
    (void)state;
    for (int share = 60; share <= 130; share += 5) {
        int late;
        WrMoving moving = { .scale = 1 };
        Machine machine = machine_of(0.003, 0.006, ALLOWED * share / 100);
        run(&moving, &machine, 100, &late);
        const int changes = run(&moving, &machine, 1000, &late);
        if (changes > 20) fail_msg("grid at %d %%: %d changes", share, changes);
    }
}

static void every_way_has_dials_and_a_name(void **state)
{
    (void)state;
    for (int way = 0; way < WR_MOVING_WAYS; way++) {
        WrDials dials = { .samples = 0 };
        wr_moving_dials((WrMovingWay)way, &dials);
        assert_true(dials.samples >= 1 && wr_moving_names[way][0] != '\0');
        assert_true((dials.aa == WR_AA_POINT) == (way == WR_MOVING_POINT));
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_finest_that_the_time_allows_is_found),
        cmocka_unit_test(a_machine_that_becomes_busy_is_followed_down_and_up_again),
        cmocka_unit_test(near_the_bound_the_way_stays),
        cmocka_unit_test(every_way_has_dials_and_a_name),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
