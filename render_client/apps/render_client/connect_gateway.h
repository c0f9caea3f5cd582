// render_client --connect: the viewer becomes a gateway's guest.
#pragma once

#include "render_client/viewer_options/viewer_options.h"

namespace bonemill {

// Comes in with the ticket of an earlier run, or else with the token, and keeps the ticket in the user's
// configuration. From then on the options have the session, and name and role that the gateway's list gives.
// Throws UserError.
void connectToGateway(ClientOptions& options);

}  // namespace bonemill
