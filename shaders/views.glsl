// Tables of lobes and pilots are made for views in even steps of the angle to the normal.
int view_of(float cos_outgoing) { return min(int(polar_angle(cos_outgoing) * (2.0 / pi) * LOBE_VIEWS), LOBE_VIEWS - 1); }
