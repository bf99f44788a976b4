wr_test(message base)
wr_test(base base OWN)
wr_test(data_files base)
wr_test(slab base)
