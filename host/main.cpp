// The `clvr` program: registers the subcommands, catches Error once.
