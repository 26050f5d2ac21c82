// none in use
