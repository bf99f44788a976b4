/* recovery_help.h - helpers of the recovery tests. Include after test.h. */
#pragma once
#include "base/memory.h"
#include "command/recovery.h"

/* The only journal. The caller frees it. */
static inline char *only_journal(void)
{
    WrRecoverable *found;
    int count;
    assert_true(wr_recovery_list(&found, &count, NULL));
    assert_int_equal(count, 1);
    char *path = wr_strdup(found[0].journal);
    wr_recovery_list_free(found, count);
    return path;
}
