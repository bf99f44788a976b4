wr_test(bump shade surface)
wr_test(bump_limits shade surface)
