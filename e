tetrace: --budget: '0' is not accepted; accepted: a positive number of seconds, or a number followed by s, m or h
