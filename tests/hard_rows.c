/* Measures the hard cases that are named and tells those that fail: hard_rows ID... Without one it names all that
   are measured. A helper of mutate.sh. */
#include <stdio.h>

#include "accuracy/hardcases.h"

int main(int count, char **ids)
{
    int failed = 0;
    for (int i = 0; count == 1 && i < WR_HARDCASES; i++)
        if (wr_hardcase(i)->measure) printf("%s\n", wr_hardcase(i)->id);
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
        if (result.verdict != WR_HARD_FAIL) continue;
        printf("%s\n", ids[i]);
        fflush(stdout);
        failed++;
    }
    return failed > 0;
}
