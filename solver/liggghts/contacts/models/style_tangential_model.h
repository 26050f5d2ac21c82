// none in use: the normal model brings the tangential force
