/* Measures the named hard cases and prints the failing ones with their precisions, or those that cannot be measured:
   hard_rows ID... Without arguments it lists the measured ones and their precisions. hard_rows --scene ID prints the
   lines of that case's scene without measuring. Used by mutate.sh and window_accuracy.sh. */
#include "base/error.h"
#include "hardcases/hardcases.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static const char *const words[WR_HARD_PRECISIONS] = { " float", " double" };

static void list(void)
{
    for (int i = 0; i < WR_HARDCASES; i++) {
        const WrHardCase *row = wr_hardcase(i);
        if (!row->measure) continue;
        printf("%s%s%s\n", row->id, isnan(row->bound[0]) ? "" : words[0],
               isnan(row->bound[1]) ? "" : words[1]);
    }
}

/* Print the precisions of a failed case that exceed their bounds. */
static void tell(const WrHardResult *result)
{
    printf("%s", result->row->id);
    for (int p = 0; p < WR_HARD_PRECISIONS; p++)
        if (!isnan(result->row->bound[p]) && !(result->worst[p] <= result->row->bound[p]))
            printf("%s", words[p]);
    printf("\n");
    fflush(stdout);
}

static int scene_of(const char *id)
{
    const WrHardCase *row = wr_hardcase_find(id);
    if (row && row->scene) return printf("%s", row->scene) < 0;
    fprintf(stderr, "hard_rows: %s: there is no such case with a scene\n", id);
    return 2;
}

int main(int count, char **ids)
{
    int failed = 0;
    if (count == 1) list();
    if (count == 3 && strcmp(ids[1], "--scene") == 0) return scene_of(ids[2]);
    for (int i = 1; i < count; i++) {
        const WrHardCase *row = wr_hardcase_find(ids[i]);
        WrHardRequest request = { 0 };
        WrHardResult result;
        WrError err = { "" };
        if (!row || !row->measure || !wr_hardcase_run(row, &request, &result, &err)) {
            fprintf(stderr, "hard_rows: %s: %s\n", ids[i],
                    row ? err.text : "there is no such case");
            return 2;
        }
        if (result.verdict == WR_HARD_UNMEASURED)
            fprintf(stderr, "hard_rows: %s: %s\n", ids[i], result.note);
        else if (result.verdict != WR_HARD_FAIL) continue;
        tell(&result);
        failed++;
    }
    return failed > 0;
}
