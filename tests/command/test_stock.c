/* The stock of the program: stamps end at height 0 and no two are alike; presets of generators and cells run, are not flat
   and seamless. */
#include "test.h"
#include "session_help.h"

#include "base/file.h"
#include "base/memory.h"
#include "base/text.h"
#include "brush/tip.h"
#include "field/seam_check.h"
#include "system/path.h"

#include <math.h>
#include <stdlib.h>

#define SMALL 32 /* side of the compared means */

/* The lines of a file of the program; the caller frees the text. */
static char *lines_of(const char *name)
{
    WrText path = { 0 };
    WrError err = { "" };
    char *text = NULL;
    size_t length;
    if (!wr_data_find(name, &path)) fail_msg("%s is missing", name);
    if (!wr_file_read(wr_text_get(&path), 1 << 20, &text, &length, &err)) fail_msg("%s", err.text);
    wr_text_fini(&path);
    return text;
}

/* Cut the first line off; NULL at the end. */
static char *next_line(char **text)
{
    char *line = *text;
    if (!*line) return NULL;
    size_t length = strcspn(line, "\n");
    *text = line + length + (line[length] != '\0');
    line[length] = '\0';
    return line;
}

/* ---- stamps ---- */

typedef struct Stamp {
    char name[40];
    double mean[SMALL * SMALL];
} Stamp;

static void check_stamp(const char *name, Stamp *stamp)
{
    WrText path = { 0 }, file = { 0 };
    WrError err = { "" };
    WrTipView view;
    int w, h;
    wr_text_addf(&file, "brushes/stamps/%s.png", name);
    if (!wr_data_find(wr_text_get(&file), &path)) fail_msg("%s is missing", wr_text_get(&file));
    WrTip *tip = wr_tip_read(wr_text_get(&path), &err);
    if (!tip) fail_msg("%s", err.text);
    wr_tip_size(tip, 0, &w, &h);
    assert_int_equal(w, 256);
    assert_int_equal(h, 256);
    wr_tip_view(tip, 0, 1.0, &view);
    double highest = 0.0, sum = 0.0;
    for (int j = 0; j < h; j++)
        for (int i = 0; i < w; i++) {
            double up = (double)view.fine[j * w + i];
            bool border = i == 0 || j == 0 || i == w - 1 || j == h - 1;
            if (border && up != 0.0) fail_msg("%s: %g at %d, %d of its border", name, up, i, j);
            highest = fmax(highest, up);
            sum += up;
            stamp->mean[j / 8 * SMALL + i / 8] += up / 64.0;
        }
    if (highest < 0.999) fail_msg("%s: its highest place is %g", name, highest);
    sum /= (double)w * h;
    if (sum < 0.003 || sum > 0.8) fail_msg("%s: its mean is %g", name, sum);
    snprintf(stamp->name, sizeof stamp->name, "%s", name);
    wr_tip_free(tip);
    wr_text_fini(&path);
    wr_text_fini(&file);
}

static void stamps_end_at_the_ground_and_differ(void **state)
{
    (void)state;
    enum { MOST = 200 };
    char *text = lines_of("brushes/stamps/stamps.conf"), *rest = text;
    Stamp *stamps = wr_alloc(MOST, sizeof *stamps);
    int count = 0;
    for (char *line; (line = next_line(&rest));) {
        char *colon = strchr(line, ':');
        if (line[0] == '#' || strncmp(line, "Group:", 6) == 0) continue;
        assert_non_null(colon);
        assert_true(strlen(colon) > 3 && count < MOST);
        *colon = '\0';
        check_stamp(line, &stamps[count++]);
    }
    assert_true(count >= 60);
    for (int a = 0; a < count; a++)
        for (int b = 0; b < a; b++) {
            double sum = 0.0;
            for (int k = 0; k < SMALL * SMALL; k++) {
                double d = stamps[a].mean[k] - stamps[b].mean[k];
                sum += d * d;
            }
            double apart = sqrt(sum / (SMALL * SMALL));
            if (apart < 0.03)
                fail_msg("%s and %s are only %g apart", stamps[a].name, stamps[b].name, apart);
        }
    wr_free(stamps);
    wr_free(text);
}

/* ---- seams ---- */

static void check_table(const WrSession *session, const char *name)
{
    const WrField *field = wr_document_field(doc(session));
    const WrSeam seam = wr_seam_measure(field, NULL);
    float low, high;
    wr_field_range(field, &low, &high);
    if (!(high - low > 1e-3f && high - low < 100.0f))
        fail_msg("%s: from %g to %g", name, (double)low, (double)high);
    if (wr_seam_shows(&seam.u) || wr_seam_shows(&seam.v))
        fail_msg("%s: a seam, of orders %d and %d", name, seam.u.order, seam.v.order);
}

static void presets_are_seamless(void **state)
{
    (void)state;
    char *text = lines_of("brushes/generators.wrinkle"), *rest = text, *name = NULL;
    int count = 0;
    for (char *line; (line = next_line(&rest));) {
        if (line[0] == '#') {
            name = line;
            continue;
        }
        if (!name || !strchr(name, ':')) fail_msg("%s: no name and words before it", line);
        WrSession *session = wr_session_new(NULL);
        must_run(session, "table 128x128");
        must_run(session, "fill 0");
        must_run(session, line);
        check_table(session, line);
        wr_session_free(session);
        name = NULL;
        count++;
    }
    assert_true(count >= 40);
    wr_free(text);
}

/* Each at an eighth of its size, in a fraction of the time. */
static void check_cell(const char *name)
{
    WrText file = { 0 };
    wr_text_addf(&file, "samples/cells/%s", name);
    char *text = lines_of(wr_text_get(&file)), *rest = text;
    WrSession *session = wr_session_new(NULL);
    int layers = 0;
    for (char *line; (line = next_line(&rest));) {
        if (line == text && (strncmp(line, "# ", 2) != 0 || !strchr(line, ':')))
            fail_msg("%s: the first line is no title with words", name);
        bool table = strncmp(line, "table ", 6) == 0;
        if (line[0] && line[0] != '#') must_run(session, table ? "table 128x128" : line);
        layers += strncmp(line, "layer add ", 10) == 0 || strncmp(line, "filter ", 7) == 0;
    }
    if (layers < 3) fail_msg("%s: only %d layers", name, layers);
    assert_int_equal(doc(session)->layer_count, layers + 1);
    check_table(session, name);
    wr_session_free(session);
    wr_text_fini(&file);
    wr_free(text);
}

static void cells_are_seamless_layers(void **state)
{
    (void)state;
    WrText path = { 0 };
    int count = 0;
    assert_true(wr_data_find("samples/cells", &path));
    WrFolder *folder = wr_folder_open(wr_text_get(&path));
    for (const char *name; (name = wr_folder_next(folder));) {
        size_t length = strlen(name);
        if (length < 9 || strcmp(name + length - 8, ".wrinkle") != 0) continue;
        check_cell(name);
        count++;
    }
    assert_true(count >= 20);
    wr_folder_close(folder);
    wr_text_fini(&path);
}

int main(void)
{
    setenv("WRINKLE_DATA", WR_SOURCE_DIR, 1);
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(stamps_end_at_the_ground_and_differ),
        cmocka_unit_test(presets_are_seamless),
        cmocka_unit_test(cells_are_seamless_layers),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
