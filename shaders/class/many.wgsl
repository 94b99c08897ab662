// More shape classes than a uniform buffer holds.

@group(0) @binding(2) var<storage, read> classes: array<Class>;
